/* Unity on the 8051: no floating point, no setjmp, and its words leave through the serial port. */
#define UNITY_EXCLUDE_FLOAT
#define UNITY_EXCLUDE_SETJMP_H
#define UNITY_INT_WIDTH     16
#define UNITY_LONG_WIDTH    32
#define UNITY_POINTER_WIDTH 32
void s51_put(int octet);
#define UNITY_OUTPUT_CHAR(octet) s51_put(octet)
