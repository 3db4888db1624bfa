/* The two views of the source document's analyzer (spec A11), one line a telegram:
 *
 *   000222 15:28:46.828821 0 0.62 -> 16.60 DP req. Slave Diag
 *   000222 15:28:46.828821 0 68 05 05 68 90 80 6d 3c 3e 00 16
 *
 * our choice: the digit after the time, whose meaning is not in the document, is 0 for a good telegram, 1 for a wrong
 * one; a short acknowledge, which carries no addresses, shows those of its request in brackets.
 */
#include "sim/mon.h"

#include <string.h>
#include <time.h>

const char *mon_service(int16_t sap)
{
    static const char *const names[] = {"Set Slave Add", "RD Inp",     "RD Outp", "Global Control",
                                        "Get Cfg",       "Slave Diag", "Set Prm", "Chk Cfg"};
    if (sap == TG_NO_SAP)
        return "Data Exchange";
    if (sap == 51)
        return "DP-V1 Read/Write";
    if (sap == 50)
        return "DP-V1 Alarm";
    return sap >= 55 && sap <= 62 ? names[sap - 55] : NULL;
}

const char *mon_answer_word(uint8_t function)
{
    static const char *const words[16] = {
        [TG_OK] = "OK",
        [TG_UE] = "UE, user error",
        [TG_RR] = "RR, no resource",
        [TG_RS] = "RS, SAP not activated",
        [TG_DL] = "DL, data",
        [TG_NR] = "NR, no data",
        [TG_DH] = "DH, data, high: diagnosis waits",
        [12] = "RDL, data, no resource",
        [13] = "RDH, data high, no resource",
    };
    return words[function & 15] ? words[function & 15] : "unknown answer function";
}

static const char *request_word(uint8_t function)
{
    static const char *const words[16] = {
        [TG_SDA_L] = "SDA low",    [TG_SDN_L] = "SDN low",     [TG_SDA_H] = "SDA high",
        [TG_SDN_H] = "SDN high",   [TG_STATUS] = "FDL Status", [TG_SRD_L] = "SRD low",
        [TG_SRD_H] = "SRD high",   [TG_IDENT] = "Ident",       [TG_LSAP] = "LSAP Status",
        [7] = "request diagnosis",
    };
    return words[function & 15] ? words[function & 15] : "unknown request function";
}

/* Time of day; a record that does not start in this century counts from its own zero. */
static void head(FILE *to, const struct mon_frame *f)
{
    const time_t s = (time_t)(f->start / 1000000000);
    struct tm t;
    if (s < 1000000000)
        gmtime_r(&s, &t);
    else
        localtime_r(&s, &t);
    fprintf(to, "%06lu %02d:%02d:%02d.%06u %d ", f->seq, t.tm_hour, t.tm_min, t.tm_sec,
            (unsigned)(f->start % 1000000000 / 1000), !f->good);
}

static void address(FILE *to, uint8_t station, int16_t sap)
{
    fprintf(to, "%u", station);
    if (sap != TG_NO_SAP)
        fprintf(to, ".%d", sap);
}

static void addresses(FILE *to, const struct tg *t)
{
    address(to, t->sa, t->ssap);
    fprintf(to, " -> ");
    address(to, t->da, t->dsap);
    fprintf(to, " ");
}

static bool is_dp(const struct tg *t)
{
    const uint8_t function = t->fc & 15;
    return function == TG_SRD_L || function == TG_SRD_H || function == TG_SDN_L || function == TG_SDN_H;
}

static void request(FILE *to, const struct mon_frame *f)
{
    const struct tg *t = &f->tg;
    const char *service = is_dp(t) ? mon_service(t->dsap) : NULL;
    if (service)
        fprintf(to, "DP req. %s", service);
    else
        fprintf(to, "FDL req. %s", request_word(t->fc));
    if (t->fc & 0x80)
        fprintf(to, ", FC bit 7 set");
    if (f->retry)
        fprintf(to, " (retry)");
}

/* An answer without SAPs is of Data Exchange only if it carries data and that was asked. */
static void answer(FILE *to, const struct mon_frame *f)
{
    static const char *const station[4] = {"slave", "master not ready", "master ready for the ring",
                                           "master in the ring"};
    const struct tg *t = &f->tg;
    const uint8_t function = t->fc & 15;
    const char *asked = f->paired && is_dp(&f->asked) ? mon_service(f->asked.dsap) : NULL;
    const char *service = t->ssap != TG_NO_SAP ? mon_service(t->ssap) : asked;
    if ((function == TG_DL || function == TG_DH) && service && (asked || t->ssap != TG_NO_SAP)) {
        fprintf(to, "DP res. %s", service);
        if (function == TG_DH)
            fprintf(to, ", diagnosis waits");
    } else if (f->paired && (f->asked.fc & 15) == TG_STATUS) {
        fprintf(to, "FDL res. FDL Status, %s, %s", mon_answer_word(t->fc), station[t->fc >> 4 & 3]);
    } else {
        fprintf(to, "FDL res. %s", mon_answer_word(t->fc));
        if (f->paired)
            fprintf(to, " to %s", asked ? asked : request_word(f->asked.fc));
    }
}

static void acknowledge(FILE *to, const struct mon_frame *f)
{
    const char *const asked = f->paired && is_dp(&f->asked) ? mon_service(f->asked.dsap) : NULL;
    if (f->paired)
        fprintf(to, "(%u -> %u) ", f->asked.da, f->asked.sa);
    fprintf(to, "FDL res. short acknowledge");
    if (f->paired)
        fprintf(to, " of %s", asked ? asked : request_word(f->asked.fc));
    else
        fprintf(to, ", nobody asked");
}

void mon_command_view(FILE *to, const struct mon_frame *f)
{
    head(to, f);
    if (!f->good) {
        fprintf(to, "wrong: %s", f->wrong);
    } else if (mon.protocol != MON_DP && mon.protocol != MON_PA) {
        mon_other_line(to, f);
    } else if (f->tg.sd == TG_SC) {
        acknowledge(to, f);
    } else if (f->tg.sd == TG_SD4) {
        addresses(to, &f->tg);
        fprintf(to, "FDL token");
    } else {
        addresses(to, &f->tg);
        (f->tg.fc & TG_REQUEST ? request : answer)(to, f);
    }
    fprintf(to, "\n");
}

void mon_hex_view(FILE *to, const struct mon_frame *f)
{
    head(to, f);
    for (unsigned i = 0; i < f->n; i++)
        fprintf(to, "%s%02x", i ? " " : "", f->octets[i]);
    fprintf(to, "\n");
}
