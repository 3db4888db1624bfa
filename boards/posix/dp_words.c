#include "dp_words.h"

#include <stdbool.h>
#include <stdio.h>

static const char *const requests[16] = {
    [TG_SDA_L] = "SDA_LOW",  [TG_SDN_L] = "SDN_LOW",     [TG_SDA_H] = "SDA_HIGH",
    [TG_SDN_H] = "SDN_HIGH", [TG_STATUS] = "FDL_STATUS", [TG_SRD_L] = "SRD_LOW",
    [TG_SRD_H] = "SRD_HIGH", [TG_IDENT] = "IDENT",       [TG_LSAP] = "LSAP_STATUS",
};
static const char *const answers[16] = {
    [TG_OK] = "OK", [TG_UE] = "UE", [TG_RR] = "RR", [TG_RS] = "RS", [TG_DL] = "DL",
    [TG_NR] = "NR", [TG_DH] = "DH", [12] = "RDL",   [13] = "RDH",
};

/* "3" or, with a service access point, "3.61". */
static const char *address_words(char *text, size_t size, uint8_t address, int16_t sap)
{
    if (sap == TG_NO_SAP)
        snprintf(text, size, "%u", address);
    else
        snprintf(text, size, "%u.%d", address, sap);
    return text;
}

void dp_fdl_words(const struct tg *t, char *text, size_t size)
{
    bool request = (t->fc & TG_REQUEST) != 0;
    const char *function = request ? requests[t->fc & 0x0F] : answers[t->fc & 0x0F];
    char da[16], sa[16], bits[20] = "";

    if (t->sd == TG_SC) {
        snprintf(text, size, "fdl=SC");
        return;
    }
    address_words(da, sizeof da, t->da, t->dsap);
    address_words(sa, sizeof sa, t->sa, t->ssap);
    if (t->sd == TG_SD4) {
        snprintf(text, size, "fdl=TOKEN da=%s sa=%s", da, sa);
        return;
    }
    if (request)
        snprintf(bits, sizeof bits, " fcb=%d fcv=%d", (t->fc & TG_FCB) != 0, (t->fc & TG_FCV) != 0);
    snprintf(text, size, "fdl=%s da=%s sa=%s%s len=%u", function ? function : "UNKNOWN", da, sa, bits, t->n);
}

static const char *by_sap(int16_t sap, bool request)
{
    static const struct {
        int16_t sap;
        const char *request, *answer;
    } services[] = {
        {55, "Set_Slave_Add.req", "Set_Slave_Add.res"},
        {56, "RD_Inp.req", "RD_Inp.res"},
        {57, "RD_Outp.req", "RD_Outp.res"},
        {58, "Global_Control.req", "Global_Control.res"},
        {59, "Get_Cfg.req", "Get_Cfg.res"},
        {60, "Slave_Diag.req", "Slave_Diag.res"},
        {61, "Set_Prm.req", "Set_Prm.res"},
        {62, "Chk_Cfg.req", "Chk_Cfg.res"},
        {TG_NO_SAP, "Data_Exchange.req", "Data_Exchange.res"},
    };

    for (size_t i = 0; i < sizeof services / sizeof *services; i++)
        if (services[i].sap == sap)
            return request ? services[i].request : services[i].answer;
    return "none";
}

static bool fdl_alone(uint8_t request_fc)
{
    uint8_t function = request_fc & 0x0F;

    return function == TG_STATUS || function == TG_IDENT || function == TG_LSAP;
}

const char *dp_service(const struct tg *t, uint8_t asked)
{
    bool request = (t->fc & TG_REQUEST) != 0;
    uint8_t function = t->fc & 0x0F;

    if (t->sd == TG_SC || t->sd == TG_SD4 || fdl_alone(request ? t->fc : asked))
        return "none";
    if (request)
        return by_sap(t->dsap, true);
    return function == TG_DL || function == TG_DH ? by_sap(t->ssap, false) : "none";
}

const char *dp_state_word(uint8_t state)
{
    static const char *const words[] = {"POWER_ON", "WAIT_PRM", "WAIT_CFG", "DATA_EXCH"};

    return state < 4 ? words[state] : "?";
}

const char *dp_wd_state_word(uint8_t wd_state)
{
    static const char *const words[] = {"BAUD_SEARCH", "BAUD_CONTROL", "DP_CONTROL"};

    return wd_state < 3 ? words[wd_state] : "?";
}
