/* The PROFIBUS rates of this board, for its GSD file: R(as GSD writes it, bit/s, max_T_SDR [T_bit]).
 * Timer 2 divides 24 MHz by 32 N: N = 78 and 39 (+0.16 %), 8 and 4 (exact). */
#ifndef FIELDLING_STC89C58RD_DP_RATES_H
#define FIELDLING_STC89C58RD_DP_RATES_H

#define BOARD_DP_RATES(R)                                                                                    \
    R(9.6, 9600, 60)                                                                                         \
    R(19.2, 19200, 60)                                                                                       \
    R(93.75, 93750, 60)                                                                                      \
    R(187.5, 187500, 60)

#endif
