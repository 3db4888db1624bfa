/* The PROFIBUS rates of this board, for its GSD file: R(as GSD writes it, bit/s, max_T_SDR [T_bit]).
 * 1.8432 MHz / 16 / N: N = 12 and 6 (exact). */
#ifndef FIELDLING_RV32VIRT_DP_RATES_H
#define FIELDLING_RV32VIRT_DP_RATES_H

#define BOARD_DP_RATES(R)                                                                                    \
    R(9.6, 9600, 60)                                                                                         \
    R(19.2, 19200, 60)

#endif
