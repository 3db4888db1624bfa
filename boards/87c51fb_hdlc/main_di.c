#define MODULE RM_DI
#include "main.h"
