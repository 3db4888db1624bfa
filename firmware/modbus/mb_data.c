/* The tables: from a range of items to the blocks of mb_map that hold them.
 *
 * Context  main
 * Nothing is moved before the range has been found and mb_check_ind() has agreed: a write changes all of its
 * items or none.
 */
#include "modbus/mb.h"
#include "hal/hal.h"

struct mb_span HOT mb_span;

/* Where mb_check() found the range: it is items offset..offset+mb_span.qty-1 of block. */
static struct {
    const struct mb_block CODE *block;
    uint16_t offset;
} HOT found;

static bool find(void)
{
    const struct mb_block CODE *b;
    for (b = mb_map; b->table; b++) {
        uint16_t i, count;
        if (b->table != mb_span.table)
            continue;
        i = (uint16_t)(mb_span.addr - b->first);
        count = b->count;
        if (MB_HAS_FILES && b->table == MB_FILE)
            i = b->first == mb_span.file ? mb_span.addr : count;
        if (i < count) {
            found.block = b;
            found.offset = i;
            return mb_span.qty <= count - i;
        }
    }
    return false;
}

uint8_t mb_check(void)
{
    return find() ? mb_check_ind() : MB_ILLEGAL_ADDRESS;
}

static uint16_t XDATA *first_register(void)
{
    return (uint16_t XDATA *)found.block->data + found.offset;
}

/* At most 125 registers fit a PDU. */
static void read_registers(void)
{
    const uint16_t XDATA *item = first_register();
    uint8_t XDATA *wire = mb_span.octets;
    uint_fast8_t left = (uint_fast8_t)mb_span.qty;
    do {
        put_u16be(wire, *item++);
        wire += 2;
    } while (--left);
}

static void write_registers(void)
{
    uint16_t XDATA *item = first_register();
    const uint8_t XDATA *wire = mb_span.octets;
    uint_fast8_t left = (uint_fast8_t)mb_span.qty;
    do {
        *item++ = get_u16be(wire);
        wire += 2;
    } while (--left);
}

/* Bit by bit, because an item need not be at bit 0. */
static void move_bits(void)
{
    uint8_t XDATA *item = (uint8_t XDATA *)found.block->data + (found.offset >> 3);
    uint8_t XDATA *wire = mb_span.octets;
    uint8_t item_bit = (uint8_t)(1u << (found.offset & 7u));
    uint8_t wire_bit = 1;
    uint16_t left = mb_span.qty;
    do {
        if (mb_span.write)
            *item = (uint8_t)(*wire & wire_bit ? *item | item_bit : *item & ~item_bit);
        else
            *wire = (uint8_t)(*item & item_bit ? *wire | wire_bit : *wire & ~wire_bit);
        item_bit = (uint8_t)(item_bit << 1);
        if (!item_bit) {
            item_bit = 1;
            item++;
        }
        wire_bit = (uint8_t)(wire_bit << 1);
        if (!wire_bit) {
            wire_bit = 1;
            wire++;
        }
    } while (--left);
}

uint8_t mb_move(void)
{
    uint8_t exception = MB_OK;
    uint8_t lock;
    if (!found.block->data) {
        exception = mb_block_ind();
    } else {
        lock = MB_LOCK();
        if (mb_span.table <= MB_INPUTS)
            move_bits();
        else if (mb_span.write)
            write_registers();
        else
            read_registers();
        MB_UNLOCK(lock);
    }
    if (mb_span.write)
        mb_written_ind();
    return exception;
}

uint8_t mb_access(void)
{
    const uint8_t exception = mb_check();
    return exception ? exception : mb_move();
}

uint8_t mb_range(uint8_t table, uint8_t regs_max)
{
    const uint16_t qty = get_u16be(mb_pdu + 3);
    mb_span.table = table;
    mb_span.addr = get_u16be(mb_pdu + 1);
    mb_span.qty = qty;
    if (table > MB_INPUTS)
        return (uint8_t)(qty <= regs_max ? 2u * qty : 0);
    return (uint8_t)(qty <= 16u * regs_max ? (qty + 7u) >> 3 : 0);
}
