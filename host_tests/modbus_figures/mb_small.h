/* The server of the comparison: functions 1-6, 15, 16, RTU only. */
#define MB_WITH_ASCII 0
#define MB_FUNCTIONS(ROW)                                                                                    \
    ROW(0x01, mb_read, 5, MB_EXACT)                                                                          \
    ROW(0x02, mb_read, 5, MB_EXACT)                                                                          \
    ROW(0x03, mb_read, 5, MB_EXACT)                                                                          \
    ROW(0x04, mb_read, 5, MB_EXACT)                                                                          \
    ROW(0x05, mb_write_one, 5, MB_EXACT | MB_BROADCAST)                                                      \
    ROW(0x06, mb_write_one, 5, MB_EXACT | MB_BROADCAST)                                                      \
    ROW(0x0F, mb_write_many, 6, MB_COUNTED | MB_BROADCAST)                                                   \
    ROW(0x10, mb_write_many, 6, MB_COUNTED | MB_BROADCAST)
