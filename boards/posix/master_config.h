/* Configuration of the HDLC master station: a text file, one item a line, # starts a comment.
 *
 *   timeout MS                               a command's answer must be there after so long; 250 when not given
 *   retry MS                                 a module that does not answer is tried again after so long; 1000
 *   misses N                                 unanswered commands in a row before a module is offline; 3
 *   module NAME ADDRESS TYPE SCAN_MS [document] [channels LIST]
 *
 * TYPE is di, do, ai or ao; SCAN_MS 0: never polled by itself; document: control octets 08/09 of the source document,
 * no connection; LIST like 0-3,7 (analog 1-6): what a scan asks for, all when not given.
 */
#ifndef FIELDLING_MASTER_CONFIG_H
#define FIELDLING_MASTER_CONFIG_H

#include "sim/hdlc_primary.h"

/* Read the file into p, after hp_init(). -> NULL, or what is wrong, with file and line, for a person. */
const char *master_config_read(const char *path, struct hp *p);

const char *master_type_word(enum hp_type type);

#endif
