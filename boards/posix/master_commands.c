#include "master_commands.h"
#include "master_config.h"
#include "options.h"
#include "report.h"

#include <stdio.h>
#include <string.h>

#define WORDS_MAX   5u
#define SAMPLES_MAX 2048u

static struct hp *primary;
static uint32_t awaited; /* id of the last request, 0: none under way */
static uint64_t wait_until_ms;
static bool quit;

static struct {
    uint8_t channel;
    uint16_t first, lost, value[SAMPLES_MAX];
    unsigned n, fetches;
} samples;

const char *state_word(const struct hp_module *m)
{
    static const char *const words[] = {"disabled", "offline", "online"};

    return words[m->state];
}

/* ---- reports ------------------------------------------------------------------------------------- */

static const char *outcome_word(enum hp_outcome outcome)
{
    static const char *const words[] = {"done", "refused", "not-sent", "unknown"};

    return words[outcome];
}

static const char *reason_word(unsigned reason)
{
    static const char *const words[] = {"?", "function", "channel", "length", "value", "hardware"};

    return words[reason < sizeof words / sizeof *words ? reason : 0];
}

static unsigned u16(const uint8_t *at)
{
    return (unsigned)at[0] << 8 | at[1];
}

static void report_diagnosis(const uint8_t *a, unsigned n)
{
    static const char *const line_keys[] = {"good",     "crc",      "abort",    "idle",      "short",    "overrun",
                                            "sent",     "underrun", "restarts", "delivered", "sequence", "resent",
                                            "rejected", "inactive", "executed", "refused",   "safe"};

    if (a[1] == 0 && n == 12) {
        report_number("type", a[2]);
        report_number("channels", a[3]);
        report_number("faults", a[4]);
        report_number("faults_seen", a[5]);
        report_number("stuck", u16(a + 6));
        report_number("passes", u16(a + 8));
        report_number("sample_ms", u16(a + 10));
    } else if (a[1] == 1) {
        for (unsigned i = 0; i < sizeof line_keys / sizeof *line_keys && 4 + 2 * i <= n; i++)
            report_number(line_keys[i], u16(a + 2 + 2 * i));
    }
}

static void report_outcome(struct hp_module *m, const struct hp_request *r, enum hp_outcome outcome, const uint8_t *a,
                           unsigned n)
{
    static const char *const names[] = {"?", "data", "control", "diagnosis", "samples"};

    report_begin(names[r->info[0] < 5 ? r->info[0] : 0]);
    report_text("module", m->name);
    report_number(r->info[0] == 3 ? "page" : "channel", r->info[1]);
    report_text("outcome", outcome_word(outcome));
    if (outcome == HP_REFUSED && n >= 3)
        report_text("reason", reason_word(a[2]));
    if (outcome == HP_DONE && r->info[0] <= 2)
        report_number("value", n >= 4 ? u16(a + 2) : a[2] == 0x31);
    if (outcome == HP_DONE && r->info[0] == 3)
        report_diagnosis(a, n);
    report_end();
}

static void report_samples(const struct hp_module *m)
{
    report_begin("samples");
    report_text("module", m->name);
    report_number("channel", samples.channel);
    report_text("outcome", "done");
    report_number("first", samples.first);
    report_number("lost", samples.lost);
    report_number("count", samples.n);
    report_list("values", samples.value, samples.n);
    report_end();
}

void commands_status(void)
{
    for (unsigned i = 0; i < primary->modules; i++) {
        const struct hp_module *m = &primary->module[i];
        report_begin("module");
        report_text("module", m->name);
        report_number("address", m->address);
        report_text("type", master_type_word(m->type));
        report_text("state", state_word(m));
        report_values("values", m->value, hp_channels(m->type), m->valid);
        report_number("commands", m->count.commands);
        report_number("answers", m->count.answers);
        report_number("timeouts", m->count.timeouts);
        report_number("repeats", m->count.repeats);
        report_number("connects", m->count.connects);
        report_number("frmr", m->count.frmr);
        report_number("dm", m->count.dm);
        report_number("refused", m->count.refused);
        report_number("duplicates", m->count.duplicates);
        report_number("strange", m->count.strange);
        report_end();
    }
}

/* ---- the primary's hooks ------------------------------------------------------------------------- */

/*   04 ch lost.16 first.16 k sample_1..sample_k; another fetch until a frame is not full. Meanwhile the module goes on
 * sampling: FETCHES_MAX frames are more than any log holds. */
#define FRAME_OCTETS 57u /* of samples: HP_INFO - 7 */
#define FETCHES_MAX  32u
static void take_samples(struct hp_module *m, const struct hp_request *r, const uint8_t *a, unsigned n)
{
    const unsigned width = hp_first_channel(m->type) ? 2 : 1;

    if (n < 7 || n != 7 + a[6] * width)
        return;
    if (samples.n == 0)
        samples.first = (uint16_t)u16(a + 4);
    samples.lost = (uint16_t)(samples.lost + u16(a + 2));
    for (unsigned i = 0; i < a[6] && samples.n < SAMPLES_MAX; i++)
        samples.value[samples.n++] = (uint16_t)(width == 2 ? u16(a + 7 + 2 * i) : a[7 + i] == 0x31);
    if (a[6] == FRAME_OCTETS / width && ++samples.fetches < FETCHES_MAX)
        awaited = hp_ask(primary, r->module, r->info, r->n);
    else
        report_samples(m);
}

static void done(struct hp *p, struct hp_module *m, const struct hp_request *r, enum hp_outcome outcome,
                 const uint8_t *answer, unsigned n)
{
    (void)p;
    if (r->id == 0)
        return;
    if (r->id == awaited)
        awaited = 0;
    if (r->info[0] == 4 && outcome == HP_DONE)
        take_samples(m, r, answer, n);
    else
        report_outcome(m, r, outcome, answer, n);
}

static void trouble(struct hp *p, struct hp_module *m, const char *what)
{
    (void)p;
    if (m->state == HP_OFFLINE && m->misses > 1) /* said before */
        return;
    report_begin("trouble");
    report_text("module", m->name);
    report_text("what", what);
    report_end();
}

void commands_init(struct hp *p)
{
    primary = p;
    p->done = done;
    p->trouble = trouble;
}

/* ---- commands ------------------------------------------------------------------------------------ */

static int find_module(const char *word)
{
    uint32_t address;

    for (unsigned i = 0; i < primary->modules; i++) {
        if (strcmp(primary->module[i].name, word) == 0)
            return (int)i;
        if (option_number(word, 0, 30, &address) && primary->module[i].address == address)
            return (int)i;
    }
    return -1;
}

static const char *ask(unsigned module, const uint8_t *info, unsigned n)
{
    awaited = hp_ask(primary, module, info, n);
    return awaited ? NULL : "too many commands are waiting";
}

/* The operator may ask for a channel a module does not have: the module says so. */
static const char *cmd_set(unsigned module, char **words)
{
    const bool analog = hp_first_channel(primary->module[module].type) == 1;
    uint32_t channel, value;
    uint8_t info[4] = {2};

    if (!option_number(words[2], 0, 255, &channel))
        return "CH is a number, 0..255";
    if (!option_number(words[3], 0, analog ? 65535 : 1, &value))
        return analog ? "V is 0..65535" : "V is 0 or 1";
    info[1] = (uint8_t)channel;
    info[2] = (uint8_t)(analog ? value >> 8 : 0x30 + value);
    info[3] = (uint8_t)value;
    return ask(module, info, analog ? 4 : 3);
}

static const char *cmd_get(unsigned module, char **words)
{
    uint32_t channel;

    if (!option_number(words[2], 0, 255, &channel))
        return "CH is a number, 0..255";
    return ask(module, (uint8_t[]){1, (uint8_t)channel}, 2);
}

static const char *cmd_samples(unsigned module, char **words)
{
    uint32_t channel;

    if (!option_number(words[2], 0, 255, &channel))
        return "CH is a number, 0..255";
    memset(&samples, 0, sizeof samples);
    samples.channel = (uint8_t)channel;
    return ask(module, (uint8_t[]){4, (uint8_t)channel, 0}, 3);
}

static const char *cmd_diag(unsigned module, char **words)
{
    (void)words;
    if (!hp_ask(primary, module, (uint8_t[]){3, 0}, 2))
        return "too many commands are waiting";
    return ask(module, (uint8_t[]){3, 1}, 2);
}

static const char *cmd_on(unsigned module, char **words)
{
    (void)words;
    hp_enable(primary, module, true);
    return NULL;
}

static const char *cmd_off(unsigned module, char **words)
{
    (void)words;
    hp_enable(primary, module, false);
    return NULL;
}

static const struct {
    const char *verb, *usage;
    unsigned words;
    const char *(*run)(unsigned module, char **words);
} verbs[] = {
    {"set", "set M CH V", 4, cmd_set}, {"get", "get M CH", 3, cmd_get}, {"samples", "samples M CH", 3, cmd_samples},
    {"diag", "diag M", 2, cmd_diag},   {"on", "on M", 2, cmd_on},       {"off", "off M", 2, cmd_off},
};

/* Commands about no module. -> it was one. */
static bool simple_command(char **words, unsigned n, uint64_t now_ms)
{
    uint32_t ms;

    if (n == 1 && strcmp(words[0], "quit") == 0)
        quit = true;
    else if (n == 1 && strcmp(words[0], "status") == 0)
        commands_status();
    else if (n == 2 && strcmp(words[0], "wait") == 0 && option_number(words[1], 0, 3600000, &ms))
        wait_until_ms = now_ms + ms;
    else
        return false;
    return true;
}

const char *commands_line(const char *text, uint64_t now_ms)
{
    static char line[200];
    char *words[WORDS_MAX];
    unsigned n = 0;
    int module;

    snprintf(line, sizeof line, "%s", text);
    for (char *w = strtok(line, " \t\r\n"); w && n < WORDS_MAX; w = strtok(NULL, " \t\r\n"))
        words[n++] = w;
    if (n == 0 || simple_command(words, n, now_ms))
        return NULL;
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++) {
        if (strcmp(verbs[i].verb, words[0]) != 0)
            continue;
        if (n != verbs[i].words)
            return verbs[i].usage;
        module = find_module(words[1]);
        return module < 0 ? "no such module" : verbs[i].run((unsigned)module, words);
    }
    return "commands: set get samples diag on off status wait quit";
}

bool commands_busy(uint64_t now_ms)
{
    return awaited != 0 || now_ms < wait_until_ms;
}

bool commands_quit(void)
{
    return quit;
}
