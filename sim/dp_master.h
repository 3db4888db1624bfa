/* A DP master: class 1 (brings slaves up, exchanges data in cycles) and class 2 (asks single questions), on
 * top of an initiator. Several masters share the bus by passing the token.
 *
 * Source: EN 50170-2 part 8 (DDLM, master side); spec A6; facts, sections 3.5 to 3.12.
 */
#ifndef SIM_DP_MASTER_H
#define SIM_DP_MASTER_H

#include "sim/initiator.h"

#define DP_DATA_MAX 244

enum dp_slave_state { DP_ABSENT, DP_DIAG1, DP_PRM, DP_CFG, DP_DIAG2, DP_EXCHANGE };

/* A slave as the master knows it. */
struct dp_slave {
    uint8_t address;
    uint16_t ident;
    uint8_t station_status; /* Set_Prm octet 1; 0x88: lock, watchdog on */
    uint8_t wd1, wd2, min_t_sdr, group;
    uint8_t user_prm_n, cfg_n, out_n, in_n;
    uint8_t user_prm[64], cfg[64];
    uint8_t outputs[DP_DATA_MAX], inputs[DP_DATA_MAX];
    /* own */
    enum dp_slave_state state;
    bool want_diag;
    uint8_t diag[DP_DATA_MAX], diag_n;
    unsigned exchanges, diags, refusals /* RS, RR, UE */, lost, starts /* times DATA_EXCH was reached */;
    unsigned wrong;    /* data of a length that was not agreed */
    unsigned patience; /* diagnoses left until ready */
};

/* A single question. Fill request (fc = function), give it to dpm_ask(), wait for state. */
enum dp_job_state { DP_JOB_WAITS, DP_JOB_DONE, DP_JOB_LOST };
struct dp_job {
    struct tg request, answer;
    enum dp_job_state state;
};

struct dp_master {
    /* set by the user before dpm_begin() */
    struct ini ini;
    struct dp_slave *slaves;
    unsigned slaves_n;
    uint64_t shortest_cycle;  /* [ticks] from the start of a cycle to the next; 0: at once */
    bool token_to_itself;     /* a token telegram each cycle, as a lone master does */
    uint8_t gap_from, gap_to; /* FDL status poll of one address a cycle; gap_to == 0: none */
    struct dp_master *ring;   /* who gets the token next; 0: nobody else */
    void (*before)(struct dp_master *m, struct dp_slave *s); /* outputs may be set; may be 0 */
    void (*after)(struct dp_master *m, struct dp_slave *s);  /* an exchange succeeded; may be 0 */
    void *of;
    /* own */
    bool has_token;
    enum { DP_NOTHING, DP_SLAVE, DP_JOB, DP_GAP, DP_TOKEN } doing;
    unsigned at;   /* slave of this cycle; slaves_n: job, gap, token */
    unsigned part; /* of the cycle's end */
    uint64_t cycle_start, cycle_time /* of the last one */;
    uint8_t gap;
    uint8_t live[127]; /* live list: 1 + station type of those that answered */
    unsigned cycles;
    struct dp_job *job;
    struct dp_slave *turn;
    bool diag_turn;
};

void dpm_begin(struct dp_master *m);

/* The same three calls as the initiator: an octet came; when to poll; poll. */
void dpm_hear(struct dp_master *m, uint64_t now, uint8_t octet, uint8_t err);
uint64_t dpm_due(const struct dp_master *m);
void dpm_poll(struct dp_master *m, uint64_t now);

/* Ask a question at the end of the running cycle. One at a time. */
void dpm_ask(struct dp_master *m, struct dp_job *job);
bool dpm_asking(const struct dp_master *m);

/* Questions. data of an answer is job->answer.data; SC shows as answer.sd == TG_SC. */
void dpq_sap(struct tg *t, uint8_t da, int16_t dsap, const uint8_t *data, uint8_t n); /* SRD high, SSAP 62 */
void dpq_diag(struct tg *t, uint8_t da);
void dpq_get_cfg(struct tg *t, uint8_t da);
void dpq_rd_inp(struct tg *t, uint8_t da);
void dpq_rd_outp(struct tg *t, uint8_t da);
void dpq_set_address(struct tg *t, uint8_t da, uint8_t new_address, uint16_t ident, uint8_t no_change);
void dpq_status(struct tg *t, uint8_t da);
void dpq_ident(struct tg *t, uint8_t da);
void dpq_lsap(struct tg *t, uint8_t da, uint8_t sap);
/* Global_Control to everybody (da = 127) or one slave; not answered. command: 0x02 clear, 0x04 unfreeze, 0x08
 * freeze, 0x10 unsync, 0x20 sync. */
void dpq_global_control(struct tg *t, uint8_t da, uint8_t command, uint8_t group);
void dpq_set_prm(struct tg *t, const struct dp_slave *s);
void dpq_chk_cfg(struct tg *t, const struct dp_slave *s);

#endif
