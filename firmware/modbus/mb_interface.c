/* Function 43: encapsulated interface transport. [A] 6.19 to 6.21.
 *
 *     request  2BH  MEI type            13 CANopen general reference (the application's), 14 identification
 *
 *     request  2BH  0EH  code  object id                 code 1 basic, 2 regular, 3 extended, 4 one object
 *     answer   2BH  0EH  code  conformity  more  next id  objects:1  (id  length  text) each
 *
 * Order of exceptions ([A] figure 29 and text): MEI type 1, code 3, object id of code 4: 2. In a stream an
 * unknown object id means 0 (the text of [A] 6.21; its figure says otherwise). A level above ours is answered
 * at ours.
 */
#include "modbus/mb_line.h"

enum { MEI_CANOPEN = 13, MEI_IDENTIFICATION = 14 };
enum { CODE_BASIC = 1, CODE_REGULAR = 2, CODE_EXTENDED = 3, CODE_ONE = 4 };

#define INDIVIDUAL_ACCESS 0x80u /* in the conformity level: code 4 is served */
#define HEADER_OCTETS     7u
#define TEXT_MAX          (MB_PDU_MAX - HEADER_OCTETS - 2u)

/* The last object id of each level, [A] 6.21 table of object ids. */
static const uint8_t CODE level_end[] = {0, 2, 0x7F, 0xFF};

static const struct mb_object CODE *find(uint8_t id)
{
    const struct mb_object CODE *object;
    for (object = mb_objects; object->text; object++)
        if (object->id == id)
            return object;
    return NULL;
}

static uint8_t text_length(const char CODE *text)
{
    uint8_t n = 0;
    while (text[n] && n < TEXT_MAX)
        n++;
    return n;
}

/* The level of the last, highest object. */
static uint8_t conformity(void)
{
    const struct mb_object CODE *object = mb_objects;
    uint8_t level = CODE_BASIC;
    for (; object->text; object++)
        while (object->id > level_end[level])
            level++;
    return level | INDIVIDUAL_ACCESS;
}

/* -> false: it does not fit any more */
static bool append(const struct mb_object CODE *object)
{
    uint8_t XDATA *to = mb_pdu + mb_pdu_len;
    const uint8_t n = text_length(object->text);
    uint8_t i;
    if (mb_pdu_len + 2u + n > MB_PDU_MAX)
        return false;
    to[0] = object->id;
    to[1] = n;
    for (i = 0; i < n; i++)
        to[2u + i] = (uint8_t)object->text[i];
    mb_pdu_len = (uint8_t)(mb_pdu_len + 2u + n);
    mb_pdu[6]++;
    return true;
}

static uint8_t identification(void)
{
    const uint8_t code = mb_pdu[2];
    const struct mb_object CODE *object = find(mb_pdu[3]);
    if (mb_pdu_len != 4 || code < CODE_BASIC || code > CODE_ONE)
        return MB_ILLEGAL_VALUE;
    if (code == CODE_ONE && !object)
        return MB_ILLEGAL_ADDRESS;
    mb_pdu[3] = conformity();
    mb_pdu[4] = 0; /* nothing more follows */
    mb_pdu[5] = 0;
    mb_pdu[6] = 0;
    mb_pdu_len = HEADER_OCTETS;
    if (code == CODE_ONE) {
        append(object);
        return MB_OK;
    }
    if (!object || object->id > level_end[code])
        object = mb_objects;
    for (; object->text && object->id <= level_end[code]; object++) {
        if (!append(object)) {
            mb_pdu[4] = 0xFF;
            mb_pdu[5] = object->id;
            break;
        }
    }
    return MB_OK;
}

uint8_t mb_interface(void)
{
    if (mb_pdu[1] == MEI_IDENTIFICATION)
        return identification();
    if (mb_pdu[1] == MEI_CANOPEN)
        return mb_canopen_ind();
    return MB_ILLEGAL_FUNCTION;
}
