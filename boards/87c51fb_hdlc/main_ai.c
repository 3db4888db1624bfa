#define MODULE RM_AI
#include "main.h"
