/* How a plug-in of the tests crashes. */
#ifndef AFTERSHADE_TESTS_CRASH_H
#define AFTERSHADE_TESTS_CRASH_H

#include <signal.h>

/* Read at run time, so that the compiler does not see the fault. */
extern int* volatile nowhere;
int* volatile nowhere = 0;

/* A wild write. Its signal ends the process under a sanitizer too, which would report it and exit. */
__attribute__((no_sanitize("address", "thread", "undefined"))) static inline void crash(void) {
    signal(SIGSEGV, SIG_DFL);
    *nowhere = 1;
}

#endif
