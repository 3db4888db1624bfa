#define MODULE RM_DO
#include "main.h"
