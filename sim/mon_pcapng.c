/* pcapng (the IETF draft "pcapng"): one interface of link type USER0 (147), times in nanoseconds, little endian.
 *
 * A packet is our own eight octets, then the telegram as it was on the line:
 *   0  version, 1
 *   1  protocol: 0 DP, 1 PA, 2 Modbus RTU, 3 Modbus ASCII, 4 HDLC
 *   2  bit 0: the analyzer found it wrong (octet errors do not show in the octets)
 *   3  0
 *   4  bit rate, 32 bits, high octet first
 * The time stamp is the start of the first start bit. sim/wireshark/profibus_dp.lua reads this.
 */
#include "sim/mon.h"

#include <string.h>

#define LINKTYPE_USER0 147u
#define PSEUDO         8u

static FILE *file;

static void put(const void *octets, size_t n)
{
    static const uint8_t zeros[4];
    fwrite(octets, 1, n, file);
    fwrite(zeros, 1, (4 - n % 4) % 4, file);
}

static void put_u32(uint32_t value)
{
    const uint8_t o[4] = {(uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16),
                          (uint8_t)(value >> 24)};
    put(o, sizeof o);
}

bool mon_pcapng_open(const char *path)
{
    static const uint8_t resolution[] = {9, 0, 1, 0, 9, 0,
                                         0, 0, 0, 0, 0, 0}; /* if_tsresol 10^-9, end of options */
    file = strcmp(path, "-") == 0 ? stdout : fopen(path, "wb");
    if (!file)
        return false;
    put_u32(0x0A0D0D0A); /* section header */
    put_u32(28);
    put_u32(0x1A2B3C4D);
    put_u32(1);                               /* version 1.0 */
    put_u32(0xFFFFFFFF), put_u32(0xFFFFFFFF); /* length of the section: unknown */
    put_u32(28);
    put_u32(1); /* interface */
    put_u32(20 + sizeof resolution);
    put_u32(LINKTYPE_USER0);
    put_u32(0); /* no limit of the packet length */
    put(resolution, sizeof resolution);
    put_u32(20 + sizeof resolution);
    return true;
}

void mon_pcapng_frame(const struct mon_frame *f)
{
    uint8_t packet[PSEUDO + MON_FRAME_MAX] = {1, (uint8_t)mon.protocol, !f->good};
    const uint32_t len = PSEUDO + f->n, padded = (len + 3) & ~3u;
    packet[4] = (uint8_t)(mon.rate >> 24);
    packet[5] = (uint8_t)(mon.rate >> 16);
    packet[6] = (uint8_t)(mon.rate >> 8);
    packet[7] = (uint8_t)mon.rate;
    memcpy(packet + PSEUDO, f->octets, f->n);
    put_u32(6); /* enhanced packet */
    put_u32(32 + padded);
    put_u32(0); /* interface 0 */
    put_u32((uint32_t)(f->start >> 32));
    put_u32((uint32_t)f->start);
    put_u32(len);
    put_u32(len);
    put(packet, len);
    put_u32(32 + padded);
    fflush(file);
}

bool mon_pcapng_close(void)
{
    return fclose(file) == 0;
}
