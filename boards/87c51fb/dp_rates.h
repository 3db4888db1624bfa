/* The PROFIBUS rates of this board, for its GSD file: R(as GSD writes it, bit/s, max_T_SDR [T_bit]).
 * Timer 2 divides 12 MHz by 32 N: N = 39 (9615 bit/s, +0.16 %), 4 and 2 (exact); 19.2 and 500 do not fit. At 187.5 kbit/s
 * cyclic traffic keeps the 60 T_bit of EN 50170-2; for any other request a master's slot time must allow more, and takes it from
 * here: 200 and main's longest lock, where the request begins under it. host_tests/s51_dp.py holds the answers against these. */
#ifndef FIELDLING_I87C51FB_DP_RATES_H
#define FIELDLING_I87C51FB_DP_RATES_H

#define BOARD_DP_RATES(R)                                                                                    \
    R(9.6, 9600, 60)                                                                                         \
    R(93.75, 93750, 60)                                                                                      \
    R(187.5, 187500, 230)

#endif
