/* The application of DP-TEST01: temperature and sensor to the master, two octets from it, over-temperature diagnosed.
 * Context: main. */
#ifndef DP_TEST01_APP_H
#define DP_TEST01_APP_H

#include "check.h"

/* Start the station: address switches 0..126 and rate as ddlm_slave_init() takes them -> enum ddlm_status. */
uint8_t dp_test01_init(uint8_t switches, uint8_t baud);

/* One turn of the main loop. */
void dp_test01_poll(void);

#endif
