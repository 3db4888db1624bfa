/* fieldling-hdlc-scan: 31 remote modules on one line in virtual time, polled by the primary; how long a scan takes
 * against what the line's bit rate allows.
 *
 * Each module is a process of its own (a station's state is static), with its own 8273 and its own virtual time. They
 * run in lockstep by pieces of the line (a module's main loop takes no time): a piece is a command of the primary,
 * the answer of one module, or silence.
 * Every module hears every piece, bit by bit, and says what it drove meanwhile: if another one spoke, it shows. */
#include "boards/posix/options.h"
#include "hal/hal.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_nrm.h"
#include "remote_board.h"
#include "remote_module.h"
#include "sim/hdlc_bus.h"
#include "sim/hdlc_primary.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#define MODULES    31u
#define PIECE_MAX  HB_BITS
#define ANSWER_MAX 1200u /* bits an answer may take, turn-round included */
#define MASTER_GAP 2u    /* bits from the end of an answer to the next command: the card's interrupt */
#define BIT_PER_S  7200.0

struct piece {
    uint32_t n;        /* bits                                                            */
    uint32_t driven;   /* from a module: bits it drove                                    */
    bool silent;       /* to a module: nobody drives                                      */
    bool until_end;    /* to a module: silence until its answer is over, at most n bits   */
    uint8_t level[PIECE_MAX];
};
#define PIECE_HEAD offsetof(struct piece, level)

/* ---- a module: a process ----------------------------------------------------------------------------------- */

static uint8_t type, address, chip_mode;
static struct piece mine;

uint16_t rm_board_inputs_isr(void) IN_ISR
{
    return 0x5555;
}

uint16_t rm_board_adc_isr(uint8_t input) IN_ISR
{
    return input == RM_BOARD_REFERENCE ? 0x800 : (uint16_t)(0x111u * (input + 1u));
}

static uint16_t digital, analog[RM_ANALOG_CHANNELS];

void rm_board_digital(uint16_t outputs)
{
    digital = outputs;
}

void rm_board_analog(uint8_t index, uint16_t value)
{
    analog[index] = value;
}

uint16_t rm_board_digital_readback(void)
{
    return digital;
}

uint16_t rm_board_analog_readback(uint8_t index)
{
    return analog[index];
}

uint16_t rm_board_program_size(void)
{
    return 1;
}

uint8_t rm_board_program_octet(uint16_t at)
{
    return (uint8_t)at;
}

uint16_t rm_board_program_crc(void)
{
    return 0;
}

uint16_t rm_board_ram_size(void)
{
    return 1;
}

uint8_t rm_board_ram_read_isr(uint16_t at) IN_ISR
{
    return (uint8_t)analog[at];
}

void rm_board_ram_write_isr(uint16_t at, uint8_t octet) IN_ISR
{
    analog[at] = octet;
}

static void init(void)
{
    rm_init(type, address, chip_mode);
}

static bool record(bool level, bool to_station)
{
    if (!to_station && mine.n < PIECE_MAX)
        mine.level[mine.n++] = level;
    return level;
}

/* Hear a piece; `mine` says what was driven. */
static void hear(const struct piece *piece)
{
    static struct hb_line line;
    const uint64_t before = hbus.driven;
    mine.n = 0;
    if (piece->until_end) {
        do
            hbus_run(1);
        while (mine.n < piece->n && (hbus.driven == before || hal_8273_chip.rts));
    } else if (piece->silent) {
        hbus_run(piece->n);
    } else {
        line.n = piece->n;
        memcpy(line.bit, piece->level, piece->n);
        hbus_say_bits(&line);
    }
    mine.driven = (uint32_t)(hbus.driven - before);
}

static void be_a_module(int fd)
{
    struct piece piece;
    hbus_begin();
    hbus_station(init, rm_poll);
    hbus.spoil = record;
    while (recv(fd, &piece, sizeof piece, 0) > 0) {
        hear(&piece);
        if (send(fd, &mine, PIECE_HEAD + mine.n, 0) < 0)
            break;
    }
    _exit(0);
}

/* ---- the line ------------------------------------------------------------------------------------------------ */

static int module_fd[MODULES];
static unsigned collisions;
static uint64_t now_bits, driven_bits;

static void exchange_with(unsigned i, const struct piece *piece, struct piece *answer)
{
    if (send(module_fd[i], piece, PIECE_HEAD + piece->n * !piece->silent, 0) < 0 ||
        recv(module_fd[i], answer, sizeof *answer, 0) <= 0) {
        fprintf(stderr, "a module has ended\n");
        exit(1);
    }
}

/* All modules but one hear it, and must be silent. */
static void all_hear(const struct piece *piece, unsigned but)
{
    static struct piece answer;
    for (unsigned i = 0; i < MODULES; i++) {
        if (i == but)
            continue;
        exchange_with(i, piece, &answer);
        collisions += answer.driven != 0;
    }
}

static void silence(unsigned bits)
{
    const struct piece piece = {.n = bits, .silent = true};
    all_hear(&piece, MODULES);
    now_bits += bits;
}

/* ---- the primary --------------------------------------------------------------------------------------------- */

static struct hp primary;
static uint8_t command[HB_OCTETS];
static unsigned command_n;

static void take_command(struct hp *p, const uint8_t *octets, unsigned n)
{
    (void)p;
    memcpy(command, octets, n);
    command_n = n;
}

static uint64_t now_ms(void)
{
    return (uint64_t)((double)now_bits * 1000.0 / BIT_PER_S);
}

static void put_on_line(struct piece *piece, const struct hb_line *line)
{
    piece->n = line->n;
    memcpy(piece->level, line->bit, line->n);
}

/* A command, and the answer of the module it is for. */
static void exchange(unsigned to)
{
    static struct hb_line line;
    static struct piece piece, answer;
    struct hb_decoder d = {0};

    memset(&line, 0, sizeof line);
    memset(&piece, 0, PIECE_HEAD);
    for (unsigned i = 0; chip_mode & HDLC_8273_PREFRAME && i < 2; i++)
        hb_raw(&line, 0x55, 8);
    hb_frame(&line, command, command_n);
    command_n = 0;
    put_on_line(&piece, &line);
    all_hear(&piece, MODULES);
    now_bits += line.n;
    driven_bits += line.n;
    hp_sent(&primary, now_ms());

    exchange_with(to, &(struct piece){.n = ANSWER_MAX, .silent = true, .until_end = true}, &answer);
    driven_bits += answer.driven;
    all_hear(&answer, to);
    now_bits += answer.n;
    for (unsigned i = 0; i < answer.n; i++)
        if (hb_decode(&d, answer.level[i]) == HB_FRAME)
            hp_frame(&primary, d.octets, d.n, now_ms());
    silence(MASTER_GAP);
}

static void run_until_ms(uint64_t end_ms)
{
    while (now_ms() < end_ms) {
        hp_poll(&primary, now_ms());
        if (command_n)
            exchange(primary.turn);
        else
            silence(7);
    }
}

/* One scan of everything, as fast as it goes: scan time 1 ms is always due. */
static unsigned answers(void)
{
    unsigned n = 0;
    for (unsigned i = 0; i < MODULES; i++)
        n += primary.module[i].count.answers;
    return n;
}

static bool document;

static void start_modules(void)
{
    static const uint8_t types[] = {RM_DI, RM_DO, RM_AI, RM_AO};
    for (unsigned i = 0; i < MODULES; i++) {
        int fd[2];
        type = document ? RM_DI : types[i % 4u];
        address = (uint8_t)i;
        struct hp_module m = {
            .address = address, .type = (enum hp_type)type, .document = document, .scan_ms = 1, .channels = 1};
        if (socketpair(AF_UNIX, SOCK_SEQPACKET, 0, fd) != 0 || !hp_add(&primary, &m))
            exit(1);
        fflush(stdout);
        if (fork() == 0) {
            for (unsigned k = 0; k < i; k++)
                close(module_fd[k]);
            close(fd[0]);
            be_a_module(fd[1]);
        }
        close(fd[1]);
        module_fd[i] = fd[0];
    }
}

static const char *take_document(const char *value)
{
    (void)value;
    document = true;
    return NULL;
}

static const char *take_preframe(const char *value)
{
    (void)value;
    chip_mode |= HDLC_8273_PREFRAME;
    return NULL;
}

static const struct option_row options[] = {
    {"document", NULL, "31 digital inputs with the document's control octets 08/09", take_document},
    {"preframe", NULL, "two octets of edges before each frame (clock recovery)", take_preframe},
    {0}};

int main(int argc, char **argv)
{
    unsigned online = 0, polls;
    uint64_t bits, busy;

    options_read(argc, argv, "fieldling-hdlc-scan: 31 remote modules on one line at 7200 bit/s, in virtual time",
                 options, "");
    hp_init(&primary);
    primary.send = take_command;
    start_modules();
    silence(20);
    run_until_ms(3000); /* connect */
    polls = answers();
    bits = now_bits;
    busy = driven_bits;
    run_until_ms(13000);
    polls = answers() - polls;
    bits = now_bits - bits;
    busy = driven_bits - busy;
    for (unsigned i = 0; i < MODULES; i++) {
        online += primary.module[i].state == HP_ONLINE && primary.module[i].count.timeouts == 0;
        close(module_fd[i]);
    }
    while (wait(NULL) > 0) {
    }
    printf("%s%s: modules=%u collisions=%u scan_ms=%.1f limit_ms=%.1f ratio=%.3f\n",
           document ? "31 digital inputs, document mode" : "31 modules of four types, NRM",
           chip_mode & HDLC_8273_PREFRAME ? ", preframe" : "", online, collisions,
           1000.0 * (double)bits / BIT_PER_S * MODULES / polls, 1000.0 * (double)busy / BIT_PER_S * MODULES / polls,
           (double)bits / (double)busy);
    return online == MODULES && collisions == 0 ? 0 : 1;
}
