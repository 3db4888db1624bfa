/* expect: fdl includes ddlm/ddlm.h, which is not below it */
#include "ddlm/ddlm.h"
