/* A plain data image for the Modbus host station, read from a text file (fieldling-modbus --map FILE). One
 * line a block; # starts a comment; numbers decimal or 0x...:
 *
 *   coils|inputs START COUNT [every N | values...]                  bit at address i: 1 where N divides i
 *   input-regs|holding-regs START COUNT [linear A B | values...]    register at address i: A*i + B
 *   file NUMBER COUNT [linear A B | values...]                      records 0..COUNT-1
 *   fifo ADDR values...                                             up to 31
 *   server-id TEXT | server-id NUMBER TEXT                          function 17; NUMBER is the id, else 0
 *
 * What is not given is 0. All of it is main. */
#ifndef FIELDLING_MB_IMAGE_H
#define FIELDLING_MB_IMAGE_H

#include "modbus/mb.h"

/* Read the file. -> NULL, or what is wrong, with the line number, for a person. */
const char *mb_image_read(const char *path);

/* What was read. */
const struct mb_block *mb_image_blocks(void);
uint8_t mb_image_server_id(uint8_t *octets);

#endif
