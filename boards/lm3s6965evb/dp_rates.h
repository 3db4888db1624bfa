/* The PROFIBUS rates of this board, for its GSD file: R(as GSD writes it, bit/s, max_T_SDR [T_bit]).
 * 50 MHz / 16, divided in steps of 1/64: all within 0.25 %, 1.5M the worst; 3M would be 0.5 % off. */
#ifndef FIELDLING_LM3S6965EVB_DP_RATES_H
#define FIELDLING_LM3S6965EVB_DP_RATES_H

#define BOARD_DP_RATES(R)                                                                                    \
    R(9.6, 9600, 60)                                                                                         \
    R(19.2, 19200, 60)                                                                                       \
    R(45.45, 45450, 60)                                                                                      \
    R(93.75, 93750, 60)                                                                                      \
    R(187.5, 187500, 60)                                                                                     \
    R(500, 500000, 100)                                                                                      \
    R(1.5M, 1500000, 150)

#endif
