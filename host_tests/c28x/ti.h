/* TI's C28x compiler for gcc's eyes: keywords and intrinsics, so that the part's own files are read by a compiler at all. */
#ifndef C28X_TI_H
#define C28X_TI_H

#define cregister
#define interrupt

unsigned int __disable_interrupts(void);
unsigned int __enable_interrupts(void);

#endif
