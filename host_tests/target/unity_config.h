/* Unity on a machine without a library: it writes octet by octet, and knows no floating point. */
#ifndef TARGET_UNITY_CONFIG_H
#define TARGET_UNITY_CONFIG_H

#define UNITY_EXCLUDE_FLOAT
#define UNITY_EXCLUDE_MATH_H
#define UNITY_EXCLUDE_LIMITS_H
#define UNITY_OUTPUT_CHAR(c)                    target_put((char)(c))
#define UNITY_OUTPUT_CHAR_HEADER_DECLARATION    target_put(char c)

#endif
