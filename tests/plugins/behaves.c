/* A library whose parameter "what" says what it does in prepare: the one library of the fault table. What it
   could do that it must not is 1 in the uniform "gain", what it was kept from 0. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include "aftershade_plugin.h"
#include "crash.h"

static void *work_of_thread(void *done) {
    *(int *)done = 1;
    return 0;
}

/* Whether "victim.txt" of the home folder can be changed in any way, or another file made beside it. */
static int changes_files(void) {
    char victim[4000], other[4096];
    const char *home = getenv("HOME");
    snprintf(victim, sizeof victim, "%s/victim.txt", home ? home : "");
    const int opened = open(victim, O_WRONLY), appended = open(victim, O_RDWR | O_APPEND);
    snprintf(other, sizeof other, "%s.new", victim);
    const int made = open(other, O_CREAT | O_WRONLY, 0600);
    return opened >= 0 || appended >= 0 || made >= 0 || truncate(victim, 0) == 0 || unlink(victim) == 0 ||
           rename(victim, other) == 0 || mkdir(other, 0700) == 0 || symlink(victim, other) == 0 ||
           link(victim, other) == 0 || chmod(victim, 0777) == 0;
}

static int starts_processes(void) {
    const pid_t child = fork();
    if (child == 0) _exit(0);
    if (child > 0) return 1;
    const pid_t light = vfork();
    if (light == 0) _exit(0);
    execl("/bin/sh", "sh", "-c", "exit 0", (char *)0);
    return light > 0 || setsid() >= 0 || setpgid(0, 0) == 0;
}

static int touches_other_processes(void) {
    char path[64], bytes[16];
    int number = 0;
    const pid_t parent = getppid();
    struct iovec mine = {bytes, sizeof bytes}, theirs = {&number, sizeof number};
    snprintf(path, sizeof path, "/proc/%d/environ", (int)parent);
    const int environ_file = open(path, O_RDONLY);
    snprintf(path, sizeof path, "/proc/%d/mem", (int)parent);
    const int memory_file = open(path, O_RDONLY);
    return environ_file >= 0 || memory_file >= 0 || kill(parent, 0) == 0 ||
           ptrace(PTRACE_SEIZE, parent, 0, 0) == 0 || process_vm_readv(parent, &mine, 1, &theirs, 1, 0) > 0 ||
           prctl(PR_SET_PDEATHSIG, 0) == 0;
}

static int opens_sockets(void) {
    int pair[2];
    return socket(AF_INET, SOCK_STREAM, 0) >= 0 || socket(AF_INET, SOCK_DGRAM, 0) >= 0 ||
           socket(AF_UNIX, SOCK_STREAM, 0) >= 0 || socketpair(AF_UNIX, SOCK_STREAM, 0, pair) == 0;
}

static int works_as_code_may(void) {
    pthread_t thread;
    int done = 0;
    if (pthread_create(&thread, 0, work_of_thread, &done) != 0 || pthread_join(thread, 0) != 0) return 0;
    char *memory = malloc(64 << 20);
    if (!memory) return 0;
    memset(memory, 1, 64 << 20);
    done = done && memory[12345] == 1;
    free(memory);
    FILE *file = fopen("/proc/self/maps", "r"); /* its own model file, say */
    char line[256];
    done = done && file && fgets(line, sizeof line, file);
    if (file) fclose(file);
    return done;
}

static int act(const char *what) {
    if (strncmp(what, "exit_", 5) == 0) _exit(atoi(what + 5));
    if (strcmp(what, "crash") == 0) crash();
    if (strcmp(what, "abort") == 0) abort();
    if (strcmp(what, "sleep") == 0) while (1) pause();
    if (strcmp(what, "spin") == 0) for (volatile int i = 0;; i = i + 1) {}
    if (strcmp(what, "talk") == 0) while (1) puts("talking and talking and talking");
    if (strcmp(what, "escape") == 0) puts("\033[2Jcleared"), fflush(stdout);
    if (strcmp(what, "memory") == 0) {
        for (size_t taken = 0; taken < (size_t)64 << 30; taken += 64 << 20) {
            char *piece = malloc(64 << 20);
            if (!piece) return 0;
            memset(piece, 1, 64 << 20);
        }
        return 1;
    }
    if (strcmp(what, "lie") == 0) { /* to the host, in the host's own language */
        const unsigned char rubbish[64] = {8, 0, 0, 0, 0, 0, 0, 0, 1};
        return write(3, rubbish, sizeof rubbish) > 0;
    }
    if (strcmp(what, "lie_long") == 0) {
        const unsigned char rubbish[8] = {255, 255, 255, 255, 255, 255, 255, 127};
        return write(3, rubbish, sizeof rubbish) > 0;
    }
    if (strcmp(what, "environment") == 0) return getenv("SECRET_TOKEN") != 0;
    if (strcmp(what, "files") == 0) return changes_files();
    if (strcmp(what, "processes") == 0) return starts_processes();
    if (strcmp(what, "others") == 0) return touches_other_processes();
    if (strcmp(what, "sockets") == 0) return opens_sockets();
    if (strcmp(what, "work") == 0) return works_as_code_may();
    return 0;
}

static aftershade_status prepare(const aftershade_instance *instance, const aftershade_frame *frame,
                                 const aftershade_output *output) {
    const char *what = "";
    (void)instance;
    frame->params->get_enum(frame->params, "what", &what);
    const float gain = (float)act(what);
    return output->set_float(output, "gain", &gain, 1);
}

static void destroy(const aftershade_instance *instance) {
    (void)instance;
}

static const aftershade_instance the_instance = {
    .struct_size = sizeof(aftershade_instance), .destroy = destroy, .prepare = prepare};

static const aftershade_instance *create(const aftershade_factory *factory, const aftershade_host *host,
                                         const char *step) {
    (void)factory, (void)host, (void)step;
    return &the_instance;
}

static const aftershade_factory the_factory = {.struct_size = sizeof(aftershade_factory),
                                               .effect_id = "behaves",
                                               .effect_version = "1.0.0",
                                               .create = create};

static const aftershade_factory *get_factory(uint32_t index) {
    (void)index;
    return &the_factory;
}

const aftershade_library AFTERSHADE_LIBRARY_ENTRY = {.struct_size = sizeof(aftershade_library),
                                                     .abi_major = AFTERSHADE_ABI_MAJOR,
                                                     .abi_minor = AFTERSHADE_ABI_MINOR,
                                                     .name = "behaves",
                                                     .version = "1.0.0",
                                                     .factory_count = 1,
                                                     .get_factory = get_factory};
