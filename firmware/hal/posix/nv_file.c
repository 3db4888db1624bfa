/* Non-volatile memory in a file of HAL_NV_SIZE octets. A new content replaces the old one at once or not at
 * all: it is written beside it, brought to the disk and renamed. */
#include "hal/hal.h"
#include "hal_host.h"
#include "line.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static char nv_path[PATH_MAX]; /* "" = no file: kept until the end of the program */
static uint8_t nv[HAL_NV_SIZE];

static bool can_create(const char *path)
{
    char folder[PATH_MAX];

    strcpy(folder, path);
    return access(dirname(folder), W_OK | X_OK) == 0;
}

const char *nv_file_open(const char *path)
{
    uint8_t content[HAL_NV_SIZE + 1u];
    ssize_t n;
    int fd;

    memset(nv, 0xFF, sizeof nv);
    if (!path)
        return NULL;
    errno = 0;
    if (*path == '\0' || strlen(path) + sizeof ".new" > sizeof nv_path)
        return line_error("--nv", "a file name is missing or too long");
    strcpy(nv_path, path);
    fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0 && errno == ENOENT)
        return can_create(path) ? NULL : line_error(path, "cannot be made there");
    if (fd < 0)
        return line_error(path, "cannot read");
    n = read(fd, content, sizeof content);
    close(fd);
    if (n < 0)
        return line_error(path, "cannot read");
    errno = 0;
    if (n != HAL_NV_SIZE)
        return line_error(path, "is not a file of a station's non-volatile memory (16 octets)");
    memcpy(nv, content, sizeof nv);
    return NULL;
}

/* Best effort: not every file system can. */
static void sync_folder(void)
{
    char folder[PATH_MAX];
    int fd;

    strcpy(folder, nv_path);
    fd = open(dirname(folder), O_RDONLY | O_CLOEXEC);
    if (fd >= 0) {
        fsync(fd);
        close(fd);
    }
}

static bool store(const uint8_t *content)
{
    char beside[PATH_MAX + 4];
    int fd, why;
    bool ok;

    if (nv_path[0] == '\0')
        return true;
    snprintf(beside, sizeof beside, "%s.new", nv_path);
    fd = open(beside, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0)
        return false;
    ok = write(fd, content, HAL_NV_SIZE) == (ssize_t)HAL_NV_SIZE && fsync(fd) == 0;
    ok = close(fd) == 0 && ok;
    if (!ok || rename(beside, nv_path) != 0) {
        why = errno;
        unlink(beside);
        errno = why;
        return false;
    }
    sync_folder();
    return true;
}

uint8_t hal_nv_read(uint8_t index)
{
    ASSERT(index < HAL_NV_SIZE);
    return nv[index];
}

bool hal_nv_write(uint8_t index, uint8_t value)
{
    uint8_t next[HAL_NV_SIZE];

    ASSERT(index < HAL_NV_SIZE);
    if (nv[index] == value && nv_path[0] == '\0')
        return true;
    memcpy(next, nv, sizeof next);
    next[index] = value;
    errno = 0;
    if (!store(next)) {
        fprintf(stderr, "%s\n", line_error(nv_path, "cannot be written"));
        return false;
    }
    memcpy(nv, next, sizeof nv);
    return true;
}
