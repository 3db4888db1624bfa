/* The requests of a DP master, written out. SAPs: spec A6; layouts beside each. */
#include "sim/dp_master.h"

#include <string.h>

#define SSAP_MASTER 62

static void request(struct tg *t, uint8_t da, uint8_t function, int16_t dsap, int16_t ssap)
{
    memset(t, 0, sizeof *t);
    t->da = da;
    t->fc = function;
    t->dsap = dsap;
    t->ssap = ssap;
}

static void add(struct tg *t, const void *data, unsigned n)
{
    memcpy(t->data + t->n, data, n);
    t->n = (uint8_t)(t->n + n);
}

void dpq_sap(struct tg *t, uint8_t da, int16_t dsap, const uint8_t *data, uint8_t n)
{
    request(t, da, TG_SRD_H, dsap, SSAP_MASTER);
    if (n)
        add(t, data, n);
}

void dpq_rd_inp(struct tg *t, uint8_t da)
{
    dpq_sap(t, da, 56, 0, 0);
}

void dpq_rd_outp(struct tg *t, uint8_t da)
{
    dpq_sap(t, da, 57, 0, 0);
}

void dpq_get_cfg(struct tg *t, uint8_t da)
{
    dpq_sap(t, da, 59, 0, 0);
}

void dpq_diag(struct tg *t, uint8_t da)
{
    dpq_sap(t, da, 60, 0, 0);
}

/* New_Slave_Add, Ident high, Ident low, No_Add_Chg */
void dpq_set_address(struct tg *t, uint8_t da, uint8_t new_address, uint16_t ident, uint8_t no_change)
{
    const uint8_t data[4] = {new_address, (uint8_t)(ident >> 8), (uint8_t)ident, no_change};
    dpq_sap(t, da, 55, data, sizeof data);
}

/* Station_status, WD_Fact_1, WD_Fact_2, min_Tsdr, Ident high, Ident low, Group_Ident, user parameters */
void dpq_set_prm(struct tg *t, const struct dp_slave *s)
{
    const uint8_t data[7] = {s->station_status, s->wd1,  s->wd2, s->min_t_sdr, (uint8_t)(s->ident >> 8),
                             (uint8_t)s->ident, s->group};
    dpq_sap(t, s->address, 61, data, sizeof data);
    add(t, s->user_prm, s->user_prm_n);
}

void dpq_chk_cfg(struct tg *t, const struct dp_slave *s)
{
    dpq_sap(t, s->address, 62, s->cfg, s->cfg_n);
}

/* Control_Command, Group_Select */
void dpq_global_control(struct tg *t, uint8_t da, uint8_t command, uint8_t group)
{
    const uint8_t data[2] = {command, group};
    request(t, da, TG_SDN_H, 58, SSAP_MASTER);
    add(t, data, sizeof data);
}

void dpq_status(struct tg *t, uint8_t da)
{
    request(t, da, TG_STATUS, TG_NO_SAP, TG_NO_SAP);
}

void dpq_ident(struct tg *t, uint8_t da)
{
    request(t, da, TG_IDENT, TG_NO_SAP, TG_NO_SAP);
}

/* The SAP in question travels as DSAP. */
void dpq_lsap(struct tg *t, uint8_t da, uint8_t sap)
{
    request(t, da, TG_LSAP, sap, SSAP_MASTER);
}
