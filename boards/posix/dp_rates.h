/* The PROFIBUS rates of this board, for its GSD file: R(as GSD writes it, bit/s, max_T_SDR [T_bit]). A pty follows any
 * rate; max_T_SDR is the standard's (spec A9). */
#ifndef FIELDLING_POSIX_DP_RATES_H
#define FIELDLING_POSIX_DP_RATES_H

#define BOARD_DP_RATES(R)                                                                                    \
    R(9.6, 9600, 60)                                                                                         \
    R(19.2, 19200, 60)                                                                                       \
    R(45.45, 45450, 60)                                                                                      \
    R(93.75, 93750, 60)                                                                                      \
    R(187.5, 187500, 60)                                                                                     \
    R(500, 500000, 100)                                                                                      \
    R(1.5M, 1500000, 150)                                                                                    \
    R(3M, 3000000, 250)                                                                                      \
    R(6M, 6000000, 450)                                                                                      \
    R(12M, 12000000, 800)

#endif
