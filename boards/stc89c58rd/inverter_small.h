/* The inverter's Modbus server where there is 1 kB of RAM: RTU, everything but the files (functions 20, 21). */
#ifndef INVERTER_SMALL_H
#define INVERTER_SMALL_H

#define MB_WITH_ASCII 0
#define MB_WITH_LUMPS 0
#define MB_FUNCTIONS(ROW)                                                                                    \
    ROW(0x01, mb_read, 5, MB_EXACT)                                                                          \
    ROW(0x02, mb_read, 5, MB_EXACT)                                                                          \
    ROW(0x03, mb_read, 5, MB_EXACT)                                                                          \
    ROW(0x04, mb_read, 5, MB_EXACT)                                                                          \
    ROW(0x05, mb_write_one, 5, MB_EXACT | MB_BROADCAST)                                                      \
    ROW(0x06, mb_write_one, 5, MB_EXACT | MB_BROADCAST)                                                      \
    ROW(0x07, mb_exception_status, 1, MB_EXACT)                                                              \
    ROW(0x08, mb_diagnostics, 3, MB_LEAST)                                                                   \
    ROW(0x0B, mb_event_counter, 1, MB_EXACT)                                                                 \
    ROW(0x0C, mb_event_log, 1, MB_EXACT)                                                                     \
    ROW(0x0F, mb_write_many, 6, MB_COUNTED | MB_BROADCAST)                                                   \
    ROW(0x10, mb_write_many, 6, MB_COUNTED | MB_BROADCAST)                                                   \
    ROW(0x11, mb_server_id, 1, MB_EXACT)                                                                     \
    ROW(0x16, mb_mask_write, 7, MB_EXACT | MB_BROADCAST)                                                     \
    ROW(0x17, mb_read_write, 10, MB_COUNTED)                                                                 \
    ROW(0x18, mb_read_fifo, 3, MB_EXACT)                                                                     \
    ROW(0x2B, mb_interface, 2, MB_LEAST)
#define MB_LOCK()         0u
#define MB_UNLOCK(state)  (void)(state)

#endif
