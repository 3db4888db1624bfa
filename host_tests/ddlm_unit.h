/* The slave of the DDLM module tests: the whole stack at 19.2 kbit/s, address 8, ident 1234H, owner master 2.
 * Requests of the owner have FC 6D, "first of a sequence": none of them is ever a retry. */
#ifndef DDLM_UNIT_H
#define DDLM_UNIT_H

#include "ddlm/ddlm.h"
#include "fake_hal.h"

/* As after power-up, address switches at `switches`. */
void station_begin(uint8_t switches);

/* Set_Prm, Chk_Cfg and inputs 31 01 as far as needed, from power-up with address 8. */
void to_wait_cfg(void);
void to_data_exch(void);

/* One turn of the main loop; the same `ms` later. */
void turn(void);
void turn_after(uint16_t ms);

/* A request, its answer, and a turn of the main loop. */
void ask(const char *hex);

/* SRD high with SAPs from station `sa` to station `da`; du as hex. The telegram is built by the test. */
void ask_sap(uint8_t da, uint8_t sa, uint8_t sap, const char *du);

/* ddlm_inputs() of octets in hexadecimal. */
void inputs(const char *hex);

extern struct ddlm_info XDATA info;
extern struct ddlm_counters XDATA counts;

#define STATE(s)                                                                                                \
    do {                                                                                                        \
        ddlm_read_info(&info);                                                                                  \
        TEST_ASSERT_EQUAL_MESSAGE(s, info.state, "state");                                                      \
    } while (0)
#define INFO(value, member)                                                                                     \
    do {                                                                                                        \
        ddlm_read_info(&info);                                                                                  \
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(value, info.member, #member);                                          \
    } while (0)
#define COUNTED(n, member)                                                                                      \
    do {                                                                                                        \
        ddlm_read_counters(&counts);                                                                            \
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(n, counts.member, #member);                                            \
    } while (0)

/* What Slave_Diag shows to a class-2 master (station 3), from Station_status_1 on. */
#define DIAG(hex)                                                                                               \
    do {                                                                                                        \
        read_diag();                                                                                            \
        OCTETS(hex, fake.sent + 9, (uint16_t)(fake.sent_len - 11u));                                            \
    } while (0)
void read_diag(void);

/* ddlm_outputs() says `kind`, and the outputs are then `hex`. */
#define OUTPUTS(kind, hex)                                                                                      \
    do {                                                                                                        \
        TEST_ASSERT_EQUAL(kind, ddlm_outputs(outputs));                                                         \
        OCTETS(hex, outputs, output_len());                                                                     \
    } while (0)
extern uint8_t XDATA outputs[16];
uint8_t output_len(void);

/* ---- the application (ddlm_unit_app.c): what it was told, and what it says ---- */

struct unit_app {
    uint8_t prm_count;
    uint8_t prm[8];
    uint8_t prm_len;
    bool prm_good;
    uint8_t cfg_count;
    uint8_t cfg_len;
    bool adapts;
    void (*while_adapting)(void);
    uint8_t states; /* indications */
    uint8_t state;
    uint8_t faults;
    uint8_t fault;
    uint8_t data_count;
    uint8_t data_sap;
};
extern struct unit_app XDATA app;

#endif
