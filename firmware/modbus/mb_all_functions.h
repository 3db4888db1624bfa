/* Every function of the server, for a configuration header: #define MB_FUNCTIONS(ROW) MB_ALL_FUNCTIONS(ROW),
 * or copy the rows you want. Broadcast: writing functions only ([S] 2.1); our choice: 22 is one, 23 is not,
 * because its answer is what it is for. */
#ifndef FIELDLING_MB_ALL_FUNCTIONS_H
#define FIELDLING_MB_ALL_FUNCTIONS_H

/*      code  handler             octets  how                            name in [A]               */
#define MB_ALL_FUNCTIONS(ROW)                                                                                \
    ROW(0x01, mb_read, 5, MB_EXACT)                        /* Read Coils                    */               \
    ROW(0x02, mb_read, 5, MB_EXACT)                        /* Read Discrete Inputs          */               \
    ROW(0x03, mb_read, 5, MB_EXACT)                        /* Read Holding Registers        */               \
    ROW(0x04, mb_read, 5, MB_EXACT)                        /* Read Input Registers          */               \
    ROW(0x05, mb_write_one, 5, MB_EXACT | MB_BROADCAST)    /* Write Single Coil             */               \
    ROW(0x06, mb_write_one, 5, MB_EXACT | MB_BROADCAST)    /* Write Single Register         */               \
    ROW(0x07, mb_exception_status, 1, MB_EXACT)            /* Read Exception Status         */               \
    ROW(0x08, mb_diagnostics, 3, MB_LEAST)                 /* Diagnostics                   */               \
    ROW(0x0B, mb_event_counter, 1, MB_EXACT)               /* Get Comm Event Counter        */               \
    ROW(0x0C, mb_event_log, 1, MB_EXACT)                   /* Get Comm Event Log            */               \
    ROW(0x0F, mb_write_many, 6, MB_COUNTED | MB_BROADCAST) /* Write Multiple Coils          */               \
    ROW(0x10, mb_write_many, 6, MB_COUNTED | MB_BROADCAST) /* Write Multiple Registers      */               \
    ROW(0x11, mb_server_id, 1, MB_EXACT)                   /* Report Server ID              */               \
    ROW(0x14, mb_read_file, 2, MB_COUNTED)                 /* Read File Record              */               \
    ROW(0x15, mb_write_file, 2, MB_COUNTED | MB_BROADCAST) /* Write File Record             */               \
    ROW(0x16, mb_mask_write, 7, MB_EXACT | MB_BROADCAST)   /* Mask Write Register           */               \
    ROW(0x17, mb_read_write, 10, MB_COUNTED)               /* Read/Write Multiple Registers */               \
    ROW(0x18, mb_read_fifo, 3, MB_EXACT)                   /* Read FIFO Queue               */               \
    ROW(0x2B, mb_interface, 2, MB_LEAST)                   /* 43/14 identification, 43/13   */

#endif
