/* The device, as its one configuration header describes it: -DFIELDLING_CONFIG='"dp_test01.h"'.
 * Here it is completed and every range is checked; no other file reads the application's header.
 *
 * The header must define (boards/common/dp_test01.h is the model):
 *   DEV_VENDOR DEV_MODEL DEV_HW_RELEASE DEV_SW_RELEASE   strings, 1..32 characters
 *   DEV_IDENT              PROFIBUS Ident_Number, 16 bits
 *   DEV_MODULES(M)         one M(name, input octets, output octets, identifier octets...) a module, in order
 *   DEV_SYNC DEV_FREEZE DEV_SET_SLAVE_ADD DEV_FAIL_SAFE  0 or 1
 *   DEV_USER_PRM_MIN DEV_USER_PRM_MAX                    user parameter octets, 0..237
 *   DEV_EXT_DIAG_MAX       extended diagnosis octets, 0..238
 *   DEV_MIN_SLAVE_INTERVAL shortest time between two polls [100 us]
 * and, for the GSD file only (gsd/gsd_main.c), which is made from the same header:
 *   DEV_ORDER DEV_FAMILY   order number; Slave_Family as GSD writes it, "0@..."
 *   DEV_USER_PRM(BIT, OCTET)  the user parameters a person may set: BIT(octet 0.., bit, default, text) for off/on,
 *                          OCTET(octet, default, min, max, text); all other bits are sent as 0
 *   DEV_DIAG_BITS(D)       D(bit, text): what bits of the device related block mean, bit 0 first after its header
 */
#ifndef FIELDLING_CONFIG_H
#define FIELDLING_CONFIG_H

#include "check.h"
#include FIELDLING_CONFIG

#define DEV_ADD_INPUTS(name, in, out, ...)  +(in)
#define DEV_ADD_OUTPUTS(name, in, out, ...) +(out)
#define DEV_IDENTIFIERS(name, in, out, ...) __VA_ARGS__,

#define DEV_INPUT_LEN  (0 DEV_MODULES(DEV_ADD_INPUTS))
#define DEV_OUTPUT_LEN (0 DEV_MODULES(DEV_ADD_OUTPUTS))

/* A modular station may accept configurations longer than its own: these are what its buffers hold. */
#ifndef DEV_INPUT_MAX
#define DEV_INPUT_MAX DEV_INPUT_LEN
#endif
#ifndef DEV_OUTPUT_MAX
#define DEV_OUTPUT_MAX DEV_OUTPUT_LEN
#endif
#ifndef DEV_CFG_MAX
#define DEV_CFG_MAX 32
#endif

/* Longest telegram body [DA..last DU octet] that is stored. A longer telegram is received, checked and, where
 * it is for us, answered RR. 249 is the standard's longest; a part with little RAM says less. */
#ifndef FDL_BODY_MAX
#define FDL_BODY_MAX 249
#endif
/* Indications that may wait for the main loop; one more is answered RR. */
#ifndef FDL_BOXES
#define FDL_BOXES 3
#endif
/* SAPs that can be active at once: DP needs 9, the rest is for the application. */
#ifndef FDL_SAPS
#define FDL_SAPS 12
#endif

/* A Data_Exchange with the wrong output length is answered RS; 1: and the station leaves data exchange with
 * Cfg_Fault (EN 50170-2 part 8; real slaves differ, so it can be turned off). */
#ifndef DDLM_WRONG_LENGTH_LEAVES
#define DDLM_WRONG_LENGTH_LEAVES 1
#endif
/* WD_Baud_Control_Val [10 ms]: without a telegram to our address for twice that time the rate is searched
 * again. our choice: 5 s, as the common ASICs have after reset. */
#ifndef DDLM_WD_BAUD_CONTROL_VAL
#define DDLM_WD_BAUD_CONTROL_VAL 250u
#endif

#if DEV_USER_PRM_MIN < 0 || DEV_USER_PRM_MAX > 237 || DEV_USER_PRM_MIN > DEV_USER_PRM_MAX
#error "user parameters: 0 <= DEV_USER_PRM_MIN <= DEV_USER_PRM_MAX <= 237"
#endif
#if DEV_EXT_DIAG_MAX < 0 || DEV_EXT_DIAG_MAX > 238
#error "DEV_EXT_DIAG_MAX is 0..238: Slave_Diag carries at most 244 octets"
#endif
#if DEV_IDENT < 0 || DEV_IDENT > 0xFFFF
#error "DEV_IDENT has 16 bits"
#endif
#if FDL_BODY_MAX < 32 || FDL_BODY_MAX > 249
#error "FDL_BODY_MAX is 32..249"
#endif
#if FDL_BOXES < 2 || FDL_BOXES > 16 || FDL_SAPS < 9 || FDL_SAPS > 65
#error "FDL_BOXES is 2..16, FDL_SAPS 9..65"
#endif
#if DEV_CFG_MAX < 1 || DEV_CFG_MAX > 244
#error "DEV_CFG_MAX is 1..244"
#endif
STATIC_ASSERT(DEV_INPUT_MAX <= 244 && DEV_OUTPUT_MAX <= 244, inputs_and_outputs_hold_at_most_244_octets);
STATIC_ASSERT(DEV_INPUT_LEN <= DEV_INPUT_MAX && DEV_OUTPUT_LEN <= DEV_OUTPUT_MAX, own_configuration_fits);
STATIC_ASSERT(DEV_OUTPUT_MAX + 3 <= FDL_BODY_MAX, outputs_fit_a_telegram_body);
STATIC_ASSERT(DEV_USER_PRM_MAX + 12 <= FDL_BODY_MAX, user_parameters_fit_a_telegram_body);

#endif
