#define MODULE RM_AO
#include "main.h"
