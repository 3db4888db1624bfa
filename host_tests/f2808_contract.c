#include "hal_contract.c" /* the same, on the model of the F2808 */
