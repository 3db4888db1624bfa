/* A capture file of HDLC frames that other people's decoders read (pcap, link type SDLC). */
#ifndef SIM_HDLC_PCAP_H
#define SIM_HDLC_PCAP_H

#include <stdint.h>
#include <stdio.h>

/* -> NULL: the file cannot be written (errno). */
FILE *hdlc_pcap_open(const char *path);

/* A frame, A C I without FCS, at time us. */
void hdlc_pcap_frame(FILE *file, const uint8_t *octets, unsigned n, uint64_t us);

#endif
