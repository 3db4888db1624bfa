/* Prints the GSD file of the device, from the configuration header the firmware is compiled from and the rates of
 * a board (-DBOARD_RATES='"boards/posix/dp_rates.h"'). With --name: only the name the file must have.
 *
 * Source: facts, section 5 (GSD revision 3); spec A9.
 */
#include "config.h"
#include BOARD_RATES

#include <stdio.h>
#include <string.h>

#define LINE_MAX_ 80

static void text(const char *keyword, const char *value)
{
    printf("%s=\"%s\"\r\n", keyword, value);
}

static void number(const char *keyword, int value)
{
    printf("%s=%d\r\n", keyword, value);
}

/* Octets behind `start`, continued with '\' before a line gets too long. */
static void octets(const char *start, const uint8_t *o, unsigned n)
{
    int column = printf("%s", start);
    for (unsigned i = 0; i < n; i++) {
        if (column + 6 > LINE_MAX_)
            column = (printf("\\\r\n"), 0);
        column += printf("0x%02X%s", o[i], i + 1 < n ? "," : "");
    }
    printf("\r\n");
}

static void identity(void)
{
    printf("; %s %s. Made by `make gsd` from the header its firmware is compiled from.\r\n", DEV_VENDOR,
           DEV_MODEL);
    printf("#Profibus_DP\r\n");
    number("GSD_Revision", 3);
    text("Vendor_Name", DEV_VENDOR);
    text("Model_Name", DEV_MODEL);
    text("Revision", DEV_SW_RELEASE);
    printf("Ident_Number=0x%04X\r\n", DEV_IDENT);
    number("Protocol_Ident", 0); /* PROFIBUS-DP */
    number("Station_Type", 0);   /* slave */
    number("FMS_supp", 0);
    text("Hardware_Release", DEV_HW_RELEASE);
    text("Software_Release", DEV_SW_RELEASE);
    text("OrderNumber", DEV_ORDER);
    printf("Slave_Family=%s\r\n", DEV_FAMILY);
    text("Implementation_Type", "Fieldling");
}

static void rates(void)
{
#define SUPPORTED(name, bit_per_s, max_t_sdr) printf(#name "_supp=1\r\n");
#define MAX_T_SDR(name, bit_per_s, max_t_sdr) printf("MaxTsdr_" #name "=%d\r\n", max_t_sdr);
    BOARD_DP_RATES(SUPPORTED)
    BOARD_DP_RATES(MAX_T_SDR)
    number("Auto_Baud_supp", 1);
}

static void abilities(void)
{
    number("Redundancy", 0);
    number("Repeater_Ctrl_Sig", 0);
    number("24V_Pins", 0);
    number("Freeze_Mode_supp", DEV_FREEZE);
    number("Sync_Mode_supp", DEV_SYNC);
    number("Set_Slave_Add_supp", DEV_SET_SLAVE_ADD);
    number("Fail_Safe", DEV_FAIL_SAFE);
    number("DPV1_Slave", 0);
    number("Min_Slave_Intervall", DEV_MIN_SLAVE_INTERVAL);
    number("Max_Diag_Data_Len", 6 + DEV_EXT_DIAG_MAX);
}

static void diagnosis(void)
{
#define DIAG_BIT(bit, meaning) printf("Unit_Diag_Bit(%d)=\"%s\"\r\n", bit, meaning);
    DEV_DIAG_BITS(DIAG_BIT)
}

/* First the descriptions, then the octets that hold the defaults, then which description belongs to which octet. */
static void user_parameters(void)
{
    uint8_t defaults[DEV_USER_PRM_MAX + 1] = {0};
    int id = 0;
    printf("PrmText=1\r\nText(0)=\"off\"\r\nText(1)=\"on\"\r\nEndPrmText\r\n");
#define DESCRIBE(meaning, type, value, range, texts)                                                         \
    printf("ExtUserPrmData=%d \"%s\"\r\n%s %d %s\r\n%sEndExtUserPrmData\r\n", ++id, meaning, type, value,    \
           range, texts);
#define DESCRIBE_BIT(octet, bit, value, meaning)                                                             \
    DESCRIBE(meaning, "Bit(" #bit ")", value, "0-1", "Prm_Text_Ref=1\r\n")
#define DESCRIBE_OCTET(octet, value, min, max, meaning)                                                      \
    DESCRIBE(meaning, "Unsigned8", value, #min "-" #max, "")
    DEV_USER_PRM(DESCRIBE_BIT, DESCRIBE_OCTET)

#define DEFAULT_BIT(octet, bit, value, meaning)        defaults[octet] |= (uint8_t)((value) << (bit));
#define DEFAULT_OCTET(octet, value, min, max, meaning) defaults[octet] = (value);
    DEV_USER_PRM(DEFAULT_BIT, DEFAULT_OCTET)
    number("Max_User_Prm_Data_Len", DEV_USER_PRM_MAX);
    octets("Ext_User_Prm_Data_Const(0)=", defaults, DEV_USER_PRM_MAX);

    id = 0;
#define REFER(octet, ...) printf("Ext_User_Prm_Data_Ref(%d)=%d\r\n", octet, ++id);
    DEV_USER_PRM(REFER, REFER)
}

/* The station takes its modules in their order and no others: each is preset, so a tool starts with all of them. */
static void modules(void)
{
    int reference = 0;
    int n = 0;
#define COUNT_MODULE(...) n++;
    DEV_MODULES(COUNT_MODULE)
    number("Modular_Station", 1);
    number("Max_Module", n);
    number("Max_Input_Len", DEV_INPUT_MAX);
    number("Max_Output_Len", DEV_OUTPUT_MAX);
    number("Max_Data_Len", DEV_INPUT_MAX + DEV_OUTPUT_MAX);
    number("Modul_Offset", 1);
#define MODULE(name, in, out, ...)                                                                           \
    {                                                                                                        \
        static const uint8_t identifier[] = {__VA_ARGS__};                                                   \
        octets("Module=\"" name "\" ", identifier, sizeof identifier);                                       \
        printf("%d\r\nPreset=1\r\nEndModule\r\n", ++reference);                                              \
    }
    DEV_MODULES(MODULE)
}

int main(int argc, char **argv)
{
    char name[16];
    /* The name: four letters of the vendor and model, the ident. */
    snprintf(name, sizeof name, "FLDL%04X.GSD", DEV_IDENT);
    if (argc > 1 && strcmp(argv[1], "--name") == 0) {
        printf("%s\n", name);
        return 0;
    }
    identity();
    rates();
    abilities();
    user_parameters();
    diagnosis();
    modules();
    return 0;
}
