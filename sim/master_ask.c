/* Class 2: single questions. Services and layouts: spec A6; facts 3.5 to 3.12. */
#include "sim/dp_master.h"
#include "sim/master.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static struct master_line *line;
static struct ini *ini;
static const struct master_options *opt;

static int usage(const char *text)
{
    fprintf(stderr, "fieldling-master: usage: %s\n", text);
    return M_USAGE;
}

static bool number(const char *text, unsigned long max, unsigned long *to)
{
    char *end;
    *to = strtoul(text, &end, 0);
    return isdigit((unsigned char)text[0]) && *end == '\0' && *to <= max;
}

static const char *refusal(uint8_t function)
{
    switch (function & 15) {
    case TG_UE:
        return "UE: user error in the station";
    case TG_RR:
        return "RR: no resource, or a wrong length";
    case TG_RS:
        return "RS: the service is not active in this state";
    case TG_NR:
        return "NR: no data";
    default:
        return "an answer that fits no question";
    }
}

/* -> M_OK with the answer in ini->answer. */
static int ask(const struct tg *request)
{
    const enum ini_event event = ml_ask(line, ini, request);
    const struct tg *const a = &ini->answer;
    if (event == INI_IDLE) {
        fprintf(stderr, "fieldling-master: the line has gone\n");
        return M_LINE;
    }
    if (event == INI_LOST) {
        fprintf(stderr, "fieldling-master: station %u does not answer\n", request->da);
        return M_SILENT;
    }
    const uint8_t function = a->fc & 15;
    if (a->sd != TG_SC && function != TG_OK && function != TG_DL && function != TG_DH) {
        fprintf(stderr, "fieldling-master: station %u refused: %s\n", request->da, refusal(a->fc));
        return M_REFUSED;
    }
    return M_OK;
}

/* ---- services ------------------------------------------------------------------------------------------- */

static unsigned set_bits(uint8_t octet, const char *const names[8], const char **to, unsigned n)
{
    for (int bit = 0; bit < 8; bit++)
        if (octet >> bit & 1 && names[bit])
            to[n++] = names[bit];
    return n;
}

static int diag(uint8_t station)
{
    static const char *const s1[8] = {
        "Station_Non_Existent", "Station_Not_Ready",      "Cfg_Fault", "Ext_Diag",
        "Not_Supported",        "Invalid_Slave_Response", "Prm_Fault", "Master_Lock"};
    static const char *const s2[8] = {"Prm_Req",     "Stat_Diag", NULL, "WD_On",
                                      "Freeze_Mode", "Sync_Mode", NULL, "Deactivated"};
    static const char *const s3[8] = {[7] = "Ext_Diag_Overflow"};
    const char *names[24];
    struct tg t;
    dpq_diag(&t, station);
    const int status = ask(&t);
    const struct tg *const a = &ini->answer;
    if (status != M_OK)
        return status;
    if (a->sd == TG_SC || a->n < 6) {
        fprintf(stderr, "fieldling-master: station %u: a diagnosis of %u octets, 6 at least\n", station,
                a->n);
        return M_REFUSED;
    }
    const unsigned n =
        set_bits(a->data[2], s3, names, set_bits(a->data[1], s2, names, set_bits(a->data[0], s1, names, 0)));
    say_begin(opt->json);
    say_number("station", station);
    say_text("ident", "0x%04X", a->data[4] << 8 | a->data[5]);
    say_text("master", a->data[3] == 255 ? "none" : "%u", a->data[3]);
    say_list("status", names, n);
    say_octets("octets", a->data, a->n);
    say_octets("extended", a->data + 6, a->n - 6u);
    say_end();
    return M_OK;
}

/* The answer's octets as they are. */
static int octets_of(const struct tg *request, const char *name)
{
    const int status = ask(request);
    if (status != M_OK)
        return status;
    say_begin(opt->json);
    say_number("station", request->da);
    say_octets(name, ini->answer.data, ini->answer.sd == TG_SC ? 0 : ini->answer.n);
    say_end();
    return M_OK;
}

static int get_cfg(uint8_t station)
{
    struct tg t;
    dpq_get_cfg(&t, station);
    return octets_of(&t, "cfg");
}

static int rd_inp(uint8_t station)
{
    struct tg t;
    dpq_rd_inp(&t, station);
    return octets_of(&t, "inputs");
}

static int rd_outp(uint8_t station)
{
    struct tg t;
    dpq_rd_outp(&t, station);
    return octets_of(&t, "outputs");
}

/* Four length octets, then four texts. */
static int ident(uint8_t station)
{
    static const char *const names[4] = {"vendor", "controller", "hardware", "software"};
    struct tg t;
    unsigned at = 4;
    dpq_ident(&t, station);
    const int status = ask(&t);
    const struct tg *const a = &ini->answer;
    if (status != M_OK)
        return status;
    say_begin(opt->json);
    say_number("station", station);
    for (unsigned i = 0; a->n >= 4 && i < 4 && at + a->data[i] <= a->n; at += a->data[i++])
        say_text(names[i], "%.*s", a->data[i], (const char *)a->data + at);
    say_end();
    return M_OK;
}

/* Access, its extension, then an octet each for SDA, SDN, SRD, CSRD: role in the high half, 3 = not activated. */
static int lsap(uint8_t station, uint8_t sap)
{
    static const char *const services[4] = {"SDA", "SDN", "SRD", "CSRD"};
    const char *active[4];
    unsigned n = 0;
    struct tg t;
    dpq_lsap(&t, station, sap);
    const int status = ask(&t);
    const struct tg *const a = &ini->answer;
    if (status != M_OK)
        return status;
    for (unsigned i = 0; i < 4 && i + 2 < a->n; i++)
        if (a->data[2 + i] >> 4 != 3)
            active[n++] = services[i];
    say_begin(opt->json);
    say_number("station", station);
    say_number("sap", sap);
    if (a->n && (a->data[0] & 127) == 127)
        say_text("access", "all");
    else if (a->n)
        say_text("access", "%u", a->data[0] & 127);
    say_list("services", active, n);
    say_octets("octets", a->data, a->n);
    say_end();
    return M_OK;
}

static bool alive(uint8_t station)
{
    struct tg t;
    dpq_status(&t, station);
    return ml_ask(line, ini, &t) == INI_DONE;
}

static int set_address(uint8_t station, uint8_t to, uint16_t number_, bool for_ever)
{
    struct tg t;
    dpq_set_address(&t, station, to, number_, for_ever);
    const int status = ask(&t);
    if (status != M_OK)
        return status;
    /* It changes when it has dealt with the request: a few tries. */
    bool there = false;
    for (unsigned i = 0; i < 10 && !there; i++)
        there = alive(to);
    if (!there) {
        fprintf(stderr,
                "fieldling-master: acknowledged, but no station answers at %u: wrong ident, locked, or not "
                "waiting "
                "for parameters\n",
                to);
        return M_REFUSED;
    }
    say_begin(opt->json);
    say_number("old", station);
    say_number("station", to);
    say_text("no_add_chg", for_ever ? "yes" : "no");
    say_end();
    return M_OK;
}

static int live_list(void)
{
    static const char *const kinds[4] = {"slave", "master not ready", "master ready", "master in ring"};
    char texts[127][32];
    const char *list[127];
    unsigned n = 0;
    for (unsigned i = 0; i <= 126; i++) {
        struct tg t;
        if (i == ini->address)
            continue;
        dpq_status(&t, (uint8_t)i);
        const enum ini_event event = ml_ask(line, ini, &t);
        if (event == INI_IDLE)
            return M_LINE;
        if (event != INI_DONE)
            continue;
        snprintf(texts[n], sizeof texts[0], "%u %s", i, kinds[ini->answer.fc >> 4 & 3]);
        list[n] = texts[n];
        n++;
    }
    say_begin(opt->json);
    say_number("count", n);
    say_list("stations", list, n);
    say_end();
    return n ? M_OK : M_SILENT;
}

/* ---- the commands --------------------------------------------------------------------------------------- */

static const struct {
    const char *verb;
    int (*of_station)(uint8_t station);
} verbs[] = {{"live-list", NULL},  {"diag", diag},   {"get-cfg", get_cfg}, {"rd-inp", rd_inp},
             {"rd-outp", rd_outp}, {"ident", ident}, {"lsap", NULL},       {"set-address", NULL}};

bool master_knows(const char *verb)
{
    for (size_t i = 0; i < sizeof verbs / sizeof verbs[0]; i++)
        if (strcmp(verbs[i].verb, verb) == 0)
            return true;
    return false;
}

int master_ask(struct master_line *l, struct ini *with, const struct master_options *o, char **words, int n)
{
    unsigned long station = 0, second = 0, third = 0;
    line = l;
    ini = with;
    opt = o;
    ini_begin(ini);
    if (strcmp(words[0], "live-list") == 0)
        return n == 1 ? live_list() : usage("live-list");
    if (n < 2 || !number(words[1], 126, &station))
        return usage("COMMAND STATION, 0 to 126");
    if (strcmp(words[0], "lsap") == 0)
        return n == 3 && number(words[2], 63, &second) ? lsap((uint8_t)station, (uint8_t)second)
                                                       : usage("lsap STATION SAP, 0 to 63");
    if (strcmp(words[0], "set-address") == 0) {
        const bool for_ever = n == 5 && strcmp(words[4], "lock") == 0;
        return (n == 4 || for_ever) && number(words[2], 125, &second) && number(words[3], 65535, &third)
                   ? set_address((uint8_t)station, (uint8_t)second, (uint16_t)third, for_ever)
                   : usage("set-address STATION NEW IDENT [lock]");
    }
    for (size_t i = 0; i < sizeof verbs / sizeof verbs[0]; i++)
        if (verbs[i].of_station && strcmp(verbs[i].verb, words[0]) == 0)
            return n == 2 ? verbs[i].of_station((uint8_t)station) : usage("COMMAND STATION");
    return usage("see --help");
}
