/* The inverter for a Modbus server. inverter_bind.c gives these to the server by name; a board with more than
 * one device (the host station) binds them itself. All of it is main. */
#ifndef INVERTER_MODBUS_H
#define INVERTER_MODBUS_H

#include "modbus/mb.h"

extern const struct mb_block CODE inv_blocks[];

uint8_t inv_check(void);                      /* mb_check_ind()     */
uint8_t inv_block(void);                      /* mb_block_ind()     */
uint8_t inv_server_id(uint8_t XDATA *octets); /* mb_server_id_ind() */

#endif
