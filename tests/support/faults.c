/* Faults of the system for tests, preloaded into the program: the call that FAULT names fails with the error ERRNO, from the call
 * number AFTER on, counted from 0. Calls of `create` make a temporary file of the program. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

static int number(const char *name) {
    const char *text = getenv(name);
    return text ? atoi(text) : 0;
}

static int fails(const char *call) {
    static int calls;
    const char *fault = getenv("FAULT");
    if (!fault || strcmp(fault, call) != 0 || calls++ < number("AFTER")) return 0;
    errno = number("ERRNO");
    return 1;
}

int fsync(int file) { return fails("fsync") ? -1 : syscall(SYS_fsync, file); }

int open64(const char *path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    int mode = flags & O_CREAT ? va_arg(rest, int) : 0;
    va_end(rest);
    if (flags & O_CREAT && strstr(path, ".whiskmap-") && fails("create")) return -1;
    return syscall(SYS_openat, AT_FDCWD, path, flags | O_LARGEFILE, mode);
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument) {
    int (*own)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *) = dlsym(RTLD_NEXT, "pthread_create");
    return fails("thread") ? errno : own(thread, attributes, start, argument);
}
