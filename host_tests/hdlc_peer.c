#include "hdlc_peer.h"

static uint8_t octets[PEER_OCTETS], want[PEER_OCTETS];

static uint8_t digit(char c)
{
    return (uint8_t)(c <= '9' ? c - '0' : c - 'A' + 10);
}

unsigned peer_hex(const char *hex, uint8_t *to)
{
    unsigned n = 0;
    while (*hex) {
        to[n++] = (uint8_t)(digit(hex[0]) << 4 | digit(hex[1]));
        hex += hex[2] ? 3 : 2;
    }
    return n;
}

void peer_answer_is(const char *answer, UNITY_LINE_TYPE line)
{
    const unsigned n = peer_hex(answer, want);
    UNITY_TEST_ASSERT_EQUAL_UINT(n, peer.answer_n, line, "length of the answer");
    UNITY_TEST_ASSERT_EQUAL_HEX8_ARRAY(want, peer.answer, n, line, "answer");
}

void peer_answers(const char *command, const char *answer, UNITY_LINE_TYPE line)
{
    const unsigned n = peer_hex(command, octets);
    peer_clear();
    UNITY_TEST_ASSERT(peer_ask(octets, n), line, "no answer, or more than one");
    peer_answer_is(answer, line);
}

void peer_silent(const char *command, UNITY_LINE_TYPE line)
{
    const unsigned n = peer_hex(command, octets);
    bool answered;
    peer_clear();
    answered = peer_ask(octets, n);
    UNITY_TEST_ASSERT(!answered && peer.answers == 0, line, "an answer where none is due");
}
