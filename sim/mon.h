/* The bus analyzer's parts: octets with times in, telegrams with their meaning out.
 *
 *   source (mon_record, port) --octets--> split --frames--> pair --frames--> views, summary, plot, pcapng
 *
 * Times are nanoseconds; spans are kept so and turned into
 * bit times for people (mon_tbit). Shares no code with firmware/
 */
#ifndef SIM_MON_H
#define SIM_MON_H

#include "sim/telegram.h"

#include <stdio.h>

enum mon_protocol { MON_DP, MON_PA, MON_MODBUS_RTU, MON_MODBUS_ASCII, MON_HDLC };

/* Errors of an octet, as a receiver reports them; in a record "10!" is a parity error, "10?" a framing error. */
enum { MON_PARITY = 1, MON_FRAMING = 2 };

#define MON_LUMPS                                                                                            \
    5000000u /* [ns] silence that ends a burst where octets come in lumps: a pty, a USB adapter */
#define MON_FRAME_MAX 600u /* octets; Modbus ASCII has the longest, 513 */

struct mon_octet {
    uint64_t start; /* [ns] of the start bit */
    uint8_t octet, err;
};

struct mon_frame {
    unsigned long seq;   /* from 0 */
    uint64_t start, end; /* [ns] first bit, end of the last stop bit */
    uint64_t idle;       /* [ns] of silence before it */
    unsigned n;
    uint8_t octets[MON_FRAME_MAX];
    bool good;
    char wrong[96]; /* why it is not good */
    struct tg tg;   /* DP and PA, when good */
    /* set by mon_pair() */
    bool answer;     /* answers `asked`, or a request that is not in the record */
    bool retry;      /* the same request again */
    bool timed;      /* t_sdr is known */
    uint64_t t_sdr;  /* [ns] */
    struct tg asked; /* the request, when `paired` */
    bool paired;
};

/* ---- settings, shared by all parts -------------------------------------------------------------------- */

struct mon_settings {
    enum mon_protocol protocol;
    uint32_t rate; /* bit/s */
    uint64_t gap;  /* [ns] silence that ends a burst; 0: 33 T_bit (DP), 3.5 characters (Modbus RTU) */
    bool untimed;  /* a pty: octets take no time, times are those of a computer */
};
extern struct mon_settings mon;

double mon_tbit(uint64_t ns); /* ns -> bit times */
uint64_t mon_char(void);      /* [ns] one character of the protocol; 0 when untimed */
double mon_us(uint64_t ns);

/* ---- octets -> frames (mon_split.c) ------------------------------------------------------------------- */

/* Called for every frame, good or not. */
typedef void mon_sink(struct mon_frame *f);

/* One more octet. Starts no earlier than the one before. */
void mon_split(const struct mon_octet *o, mon_sink *sink);

/* Nothing came until `now`: what is complete by then is given out. mon_split_end(): all of it. */
void mon_split_idle(uint64_t now, mon_sink *sink);
void mon_split_end(mon_sink *sink);

/* What is wrong with these octets as one DP telegram; "" when nothing is. err may be NULL. */
void mon_judge_dp(const uint8_t *octets, const uint8_t *err, unsigned n, char *text, size_t size);

/* Frames of the other protocols (mon_other.c, mon_modbus.c): fills good, wrong, tg. */
void mon_judge_other(struct mon_frame *f);
void mon_modbus_judge(struct mon_frame *f);

/* ---- frames -> meaning -------------------------------------------------------------------------------- */

/* Finds request and answer, retries and T_SDR of DP (mon_pair.c), of PA likewise; request and response time of Modbus. */
void mon_pair(struct mon_frame *f);
void mon_modbus_pair(struct mon_frame *f);

/* One line: sequence number, time, 0 good / 1 wrong, then addresses and service, or the octets (mon_view.c). */
void mon_command_view(FILE *to, const struct mon_frame *f);
void mon_hex_view(FILE *to, const struct mon_frame *f);

/* Lines of content, indented (mon_details.c, mon_other.c). */
void mon_details(FILE *to, const struct mon_frame *f);
void mon_other_line(FILE *to, const struct mon_frame *f);
void mon_other_details(FILE *to, const struct mon_frame *f);
void mon_modbus_line(FILE *to, const struct mon_frame *f);
void mon_modbus_details(FILE *to, const struct mon_frame *f);

/* "Slave Diag" of a SAP; NULL: not one of DP's. */
const char *mon_service(int16_t sap);
const char *mon_answer_word(uint8_t function);

/* ---- collectors --------------------------------------------------------------------------------------- */

void mon_stats_frame(const struct mon_frame *f);
void mon_stats_print(FILE *to);

void mon_plot_frame(const struct mon_frame *f);
bool mon_plot_write(const char *path);

bool mon_pcapng_open(const char *path);
void mon_pcapng_frame(const struct mon_frame *f);
bool mon_pcapng_close(void);

/* ---- records: text files of octets with times (mon_record.c) ------------------------------------------- */

/* Read a record: "# rate 500000" sets mon.rate unless `rate_fixed`; "# untimed" says that the times are a computer's and
 * not the line's; then lines "SECONDS HEX HEX ...", the time of the
 * first start bit; the octets of a line follow each other without a gap. '#' starts a comment.
 * -> 0, or the number of a line that is none of these. */
unsigned mon_record_read(FILE *from, bool rate_fixed, mon_sink *sink);

/* Write one frame as such a line; mon_record_head() writes the rate. */
void mon_record_head(FILE *to);
void mon_record_frame(FILE *to, const struct mon_frame *f);

#endif
