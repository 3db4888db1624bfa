/* The document's echo-back program: SCI-A with FIFOs, polled. */
#ifndef ECHO_BACK_H
#define ECHO_BACK_H

/* Set SCI-A up for 9600 bit/s, 8N1, as the document does, and greet. After the clocks and pins of hal_init(). */
void echo_back_begin(void);

/* One character: ask for it, wait, say it. */
void echo_back_one(void);

#endif
