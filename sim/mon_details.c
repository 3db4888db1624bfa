/* Content of DP telegrams in words. Layouts: EN 50170-2 part 8; spec A6; facts 3.7 to 3.11. */
#include "sim/mon.h"

#include <stdarg.h>
#include <string.h>

static FILE *out;

static void line(const char *name, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fprintf(out, "        %-22s ", name);
    vfprintf(out, format, args);
    fprintf(out, "\n");
    va_end(args);
}

static void hex_line(const char *name, const uint8_t *o, unsigned n)
{
    fprintf(out, "        %-22s", name);
    for (unsigned i = 0; i < n; i++)
        fprintf(out, " %02X", o[i]);
    fprintf(out, "\n");
}

/* The names of the bits that are set, highest first; NULL: reserved. */
static void bits(const char *name, uint8_t octet, const char *const names[8])
{
    fprintf(out, "        %-22s %02X", name, octet);
    for (int bit = 7; bit >= 0; bit--)
        if (octet >> bit & 1) {
            if (names[bit])
                fprintf(out, " %s", names[bit]);
            else
                fprintf(out, " reserved-bit-%d", bit);
        }
    fprintf(out, "\n");
}

/* ---- Set_Prm ------------------------------------------------------------------------------------------ */

static const char *lock_word(uint8_t status)
{
    static const char *const words[4] = {"only min_T_SDR changes", "unlock for other masters",
                                         "lock to this master", "unlock for other masters"};
    return words[status >> 6];
}

static void user_prm(const uint8_t *o, unsigned n)
{
    static const char *const s1[8] = {
        [7] = "DPV1_Enable", [6] = "Fail_Safe",        [5] = "Publisher_Enable",
        [2] = "WD_Base_1ms", [1] = "Dis_Stop_Control", [0] = "Dis_Start_Control"};
    static const char *const s2[8] = {"Check_Cfg_Mode",     NULL,
                                      "Update_Alarm",       "Status_Alarm",
                                      "Manufacturer_Alarm", "Diagnostic_Alarm",
                                      "Process_Alarm",      "Pull_Plug_Alarm"};
    static const char *const s3[8] = {"Alarm_Mode.0", "Alarm_Mode.1", "Alarm_Mode.2", "Prm_Structure",
                                      "IsoM_Req",     NULL,           NULL,           "PrmCmd"};
    if (n == 0)
        return;
    hex_line("user parameters", o, n);
    if (n >= 3 && o[0] & 0x80) { /* in pure DP the octets are the maker's */
        bits("  DPV1_Status_1", o[0], s1);
        bits("  DPV1_Status_2", o[1], s2);
        bits("  DPV1_Status_3", o[2], s3);
    }
}

static void set_prm(const uint8_t *o, unsigned n)
{
    static const char *const names[8] = {
        [7] = "Lock_Req", [6] = "Unlock_Req", [5] = "Sync_Req", [4] = "Freeze_Req", [3] = "WD_On"};
    if (n < 7) {
        line("too short", "%u octets, Set_Prm has 7 at least", n);
        return;
    }
    bits("Station_status", o[0], names);
    line("lock", "%s", lock_word(o[0]));
    const unsigned base = n > 7 && (o[7] & 0x84) == 0x84 ? 1 : 10;
    if (o[0] & 0x08)
        line("watchdog", "%u x %u x %u ms = %u ms", o[1], o[2], base, o[1] * o[2] * base);
    else
        line("watchdog", "off");
    if (o[3])
        line("min_T_SDR", "%u T_bit", o[3]);
    else
        line("min_T_SDR", "unchanged");
    line("Ident_Number", "%02X%02XH", o[4], o[5]);
    line("Group_Ident", "%02X", o[6]);
    user_prm(o + 7, n - 7);
}

/* ---- Slave_Diag --------------------------------------------------------------------------------------- */

static void device_block(const uint8_t *o, unsigned n)
{
    hex_line("device related", o + 1, n - 1);
    if (n >= 4 && o[1] == 0x81)
        line("  status message", "slot %u, specifier %u", o[2], o[3]);
    else if (n >= 4 && o[1] == 0x82)
        line("  module status", "slot %u, specifier %u", o[2], o[3]);
}

static void identifier_block(const uint8_t *o, unsigned n)
{
    fprintf(out, "        %-22s modules", "identifier related");
    unsigned found = 0;
    for (unsigned i = 8; i < n * 8; i++)
        if (o[i / 8] >> i % 8 & 1)
            fprintf(out, "%s %u", found++ ? "," : "", i - 8);
    fprintf(out, found ? "\n" : " none\n");
}

static void channel_block(const uint8_t *o)
{
    static const char *const directions[4] = {"", "input ", "output ", "in/out "};
    static const char *const types[8] = {"?", "bit", "2 bit", "4 bit", "byte", "word", "2 words", "?"};
    static const char *const errors[10] = {"?",
                                           "short circuit",
                                           "undervoltage",
                                           "overvoltage",
                                           "overload",
                                           "over-temperature",
                                           "line break",
                                           "upper limit exceeded",
                                           "lower limit exceeded",
                                           "error"};
    const unsigned error = o[2] & 31;
    line("channel related", "module %u %schannel %u, %s: %s (%u)", o[0] & 63, directions[o[1] >> 6],
         o[1] & 63, types[o[2] >> 5],
         error < 10   ? errors[error]
         : error < 16 ? "reserved"
                      : "maker's own",
         error);
}

static void ext_diag(const uint8_t *o, unsigned n)
{
    while (n) {
        const unsigned kind = o[0] >> 6;
        const unsigned len = kind == 2 ? 3 : o[0] & 63;
        if (kind == 3) {
            hex_line("revision, block C0", o, n < 2 ? n : 2);
            o += n < 2 ? n : 2, n -= n < 2 ? n : 2;
            continue;
        }
        if (len < 2 || len > n) {
            hex_line("malformed block", o, n);
            return;
        }
        if (kind == 0)
            device_block(o, len);
        else if (kind == 1)
            identifier_block(o, len);
        else
            channel_block(o);
        o += len, n -= len;
    }
}

static void slave_diag(const uint8_t *o, unsigned n)
{
    static const char *const s1[8] = {
        "Station_Non_Existent", "Station_Not_Ready",      "Cfg_Fault", "Ext_Diag",
        "Not_Supported",        "Invalid_Slave_Response", "Prm_Fault", "Master_Lock"};
    static const char *const s2[8] = {"Prm_Req",     "Stat_Diag", "always-1", "WD_On",
                                      "Freeze_Mode", "Sync_Mode", NULL,       "Deactivated"};
    static const char *const s3[8] = {[7] = "Ext_Diag_Overflow"};
    if (n < 6) {
        line("too short", "%u octets, Slave_Diag has 6 at least", n);
        return;
    }
    bits("Station_status_1", o[0], s1);
    bits("Station_status_2", o[1], s2);
    bits("Station_status_3", o[2], s3);
    if (o[3] == 255)
        line("Master_Add", "none");
    else
        line("Master_Add", "%u", o[3]);
    line("Ident_Number", "%02X%02XH", o[4], o[5]);
    ext_diag(o + 6, n - 6);
}

/* ---- configuration ------------------------------------------------------------------------------------ */

static void part(char *text, size_t size, uint8_t coded, uint8_t mask, const char *direction)
{
    const size_t at = strlen(text);
    const unsigned n = (coded & mask) + 1u;
    snprintf(text + at, size - at, "%s%u %s%s %s%s", at ? ", " : "", n, coded & 0x40 ? "word" : "byte",
             n > 1 ? "s" : "", direction, coded & 0x80 ? ", consistent as a whole" : "");
}

/* -> octets used */
static unsigned identifier(const uint8_t *o, unsigned n)
{
    static const char *const directions[4] = {"", "in", "out", "in and out"};
    char name[16], text[120] = "";
    unsigned at = 1;
    snprintf(name, sizeof name, "identifier %02X", o[0]);
    if (o[0] & 0x30) {
        part(text, sizeof text, o[0], 0x0F, directions[o[0] >> 4 & 3]);
        line(name, "%s", text);
        return 1;
    }
    const unsigned maker = (o[0] & 15) == 15 ? 0 : o[0] & 15;
    const unsigned lengths = (o[0] >> 7) + (o[0] >> 6 & 1u);
    if (1 + maker + lengths > n) {
        line(name, "cut short: %u more octets announced, %u follow", maker + lengths, n - 1);
        return n;
    }
    if (o[0] & 0x80)
        part(text, sizeof text, o[at++], 0x3F, "out");
    if (o[0] & 0x40)
        part(text, sizeof text, o[at++], 0x3F, "in");
    line(name, "%s%s", text[0] ? text : "empty slot", maker ? ", maker's octets follow" : "");
    if (maker)
        hex_line("  maker's octets", o + at, maker);
    return at + maker;
}

static void configuration(const uint8_t *o, unsigned n)
{
    for (unsigned at = 0; at < n;)
        at += identifier(o + at, n - at);
}

/* ---- the others --------------------------------------------------------------------------------------- */

static void global_control(const uint8_t *o, unsigned n)
{
    static const char *const names[8] = {
        [1] = "Clear_Data", [2] = "Unfreeze", [3] = "Freeze", [4] = "Unsync", [5] = "Sync"};
    if (n != 2) {
        line("wrong length", "%u octets, Global_Control has 2", n);
        return;
    }
    bits("Control_Command", o[0], names);
    if (o[0] == 0)
        line("meaning", "Operate");
    if (o[1])
        line("Group_Select", "%02X", o[1]);
    else
        line("Group_Select", "00, all slaves");
}

static void set_slave_add(const uint8_t *o, unsigned n)
{
    if (n < 4) {
        line("too short", "%u octets, Set_Slave_Add has 4 at least", n);
        return;
    }
    line("New_Slave_Add", "%u", o[0]);
    line("Ident_Number", "%02X%02XH", o[1], o[2]);
    line("No_Add_Chg", "%s", o[3] ? "yes" : "no");
    if (n > 4)
        hex_line("Rem_Slave_Data", o + 4, n - 4);
}

/* Four length octets, then vendor, controller, hardware and software release (EN 50170-2 part 4, Ident). */
static void ident(const uint8_t *o, unsigned n)
{
    static const char *const names[4] = {"Vendor_Name", "Controller_type", "HW release", "SW release"};
    unsigned at = 4;
    for (unsigned i = 0; n >= 4 && i < 4 && at + o[i] <= n; at += o[i++])
        line(names[i], "\"%.*s\"", o[i], (const char *)o + at);
}

static void frame_control(const struct mon_frame *f)
{
    const struct tg *t = &f->tg;
    if (t->fc & TG_REQUEST)
        line("FC", "%02X request, FCB %d, FCV %d", t->fc, (t->fc & TG_FCB) != 0, (t->fc & TG_FCV) != 0);
    else
        line("FC", "%02X answer, %s", t->fc, mon_answer_word(t->fc));
    if (f->timed)
        line("T_SDR", "%.0f T_bit", mon_tbit(f->t_sdr));
}

static void service(const struct tg *t, int16_t sap, bool request)
{
    const uint8_t *const o = t->data;
    if (sap == 61 && request)
        set_prm(o, t->n);
    else if (sap == 60 && !request)
        slave_diag(o, t->n);
    else if ((sap == 62 && request) || (sap == 59 && !request))
        configuration(o, t->n);
    else if (sap == 58 && request)
        global_control(o, t->n);
    else if (sap == 55 && request)
        set_slave_add(o, t->n);
    else if (t->n)
        hex_line(sap == TG_NO_SAP ? (request ? "outputs" : "inputs") : "data", o, t->n);
}

void mon_details(FILE *to, const struct mon_frame *f)
{
    out = to;
    if (mon.protocol != MON_DP && mon.protocol != MON_PA) {
        mon_other_details(to, f);
        return;
    }
    if (!f->good || f->tg.sd == TG_SC || f->tg.sd == TG_SD4) {
        if (f->good && f->timed)
            line("T_SDR", "%.0f T_bit", mon_tbit(f->t_sdr));
        return;
    }
    frame_control(f);
    if (f->paired && (f->asked.fc & 15) == TG_IDENT && !(f->tg.fc & TG_REQUEST))
        ident(f->tg.data, f->tg.n);
    else
        service(&f->tg, f->tg.fc & TG_REQUEST ? f->tg.dsap : f->tg.ssap, (f->tg.fc & TG_REQUEST) != 0);
}
