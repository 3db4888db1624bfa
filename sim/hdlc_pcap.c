#include "sim/hdlc_pcap.h"

/* Source: pcap file format (draft-ietf-opsawg-pcap), LINKTYPE_SDLC = 268; little endian here. */
#define MAGIC         0xA1B2C3D4u
#define SNAP          65535u
#define LINKTYPE_SDLC 268u

static void put(FILE *file, uint32_t value, unsigned octets)
{
    for (; octets; octets--, value >>= 8)
        fputc((int)(value & 0xFFu), file);
}

FILE *hdlc_pcap_open(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        return NULL;
    put(file, MAGIC, 4);
    put(file, 2, 2);
    put(file, 4, 2);
    put(file, 0, 4);
    put(file, 0, 4);
    put(file, SNAP, 4);
    put(file, LINKTYPE_SDLC, 4);
    return file;
}

void hdlc_pcap_frame(FILE *file, const uint8_t *octets, unsigned n, uint64_t us)
{
    put(file, (uint32_t)(us / 1000000u), 4);
    put(file, (uint32_t)(us % 1000000u), 4);
    put(file, n, 4);
    put(file, n, 4);
    fwrite(octets, 1, n, file);
    fflush(file);
}
