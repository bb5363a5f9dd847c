/* A library that tries to reach out of its process, a line of standard output for each attempt:
   name|what it changes|result|errno|whether /proc shows this process changed|what it read. Where it runs
   alone, each attempt has a process of its own. */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <linux/perf_event.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/inotify.h>
#include <sys/ipc.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/msg.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <time.h>
#include <unistd.h>

#include "aftershade_plugin.h"

/* From the file "outside" in the home folder. */
static int victim, file_number, tcp_port, udp_port;
static char folder[2000], own_name[64]; /* of all that is made, after the test's process */
static key_t key;
static struct iovec mine, theirs;

static char got[64];
static cpu_set_t last_cpu;
static struct { uint32_t size, policy; uint64_t flags; int32_t nice; uint32_t priority; uint64_t times[3]; }
    idle = {48, 5, 0, 0, 0, {0}}; /* SCHED_IDLE */
static struct perf_event_attr software_clock = {
    .type = PERF_TYPE_SOFTWARE, .size = sizeof(struct perf_event_attr), .exclude_kernel = 1};
static unsigned long one_node = 1, ring_context;
static uint64_t process[8] = {0, 0, 0, 0, SIGCHLD}, truncating[3] = {O_WRONLY | O_TRUNC};
static char *no_words[1];
static uint32_t ring[40], map[16] = {2, 4, 4, 1}, handle[40] = {128}, clock_request[64] = {1}, own_word;
static struct flock read_lock = {.l_type = F_RDLCK};
static struct timespec long_ago[2];
static struct { uint16_t code; uint8_t yes, no; uint32_t value; } allow = {6, 0, 0, 0x7fff0000};
static struct { unsigned short count; void *code; } allow_all = {1, &allow};
static int pair[2];

static const char *at(const char *name) {
    static char paths[4][2100];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}
static const char *in_proc(const char *name) {
    static char path[64];
    snprintf(path, sizeof path, "/proc/%d/%s", victim, name);
    return path;
}
static const char *file_of_victim(void) {
    char name[16];
    snprintf(name, sizeof name, "fd/%d", file_number);
    return in_proc(name);
}
static const char *shared_memory(void) {
    static char path[80];
    snprintf(path, sizeof path, "/dev/shm/%s", own_name);
    return path;
}
static int folder_of_victim(void) { return open(in_proc(""), O_RDONLY | O_DIRECTORY); }
static int pidfd(void) { return (int)syscall(SYS_pidfd_open, victim, 0); }

static long read_at(const char *path, off_t place) {
    const int file = open(path, O_RDONLY);
    if (file < 0) return -1;
    const ssize_t count = pread(file, got, sizeof got - 1, place);
    return count;
}
static long write_at(const char *path, off_t place) {
    const int file = open(path, O_WRONLY);
    return file < 0 ? -1 : pwrite(file, "yours", 5, place);
}
static long write_text(const char *path, const char *text) {
    const int file = open(path, O_WRONLY);
    return file < 0 ? -1 : write(file, text, strlen(text));
}
static long steal_file(void) {
    const long file = syscall(SYS_pidfd_getfd, pidfd(), file_number, 0);
    return file < 0 ? -1 : pread((int)file, got, sizeof got - 1, 0);
}
static long queue_to_thread(int number) {
    siginfo_t info = {.si_signo = number, .si_code = SI_QUEUE};
    return syscall(SYS_rt_tgsigqueueinfo, victim, victim, number, &info);
}
static long own_signals(void) {
    int ends[2];
    return pipe(ends) != 0 ? -1 : fcntl(ends[0], F_SETOWN, victim);
}
static long clone_as(unsigned long flags) { return syscall(SYS_clone, flags | SIGCHLD, 0, 0, 0, 0); }
static long survive(const char *name, long child) {
    if (child != 0) return child;
    char whole[80];
    snprintf(whole, sizeof whole, "%s-%s", own_name, name);
    prctl(PR_SET_NAME, whole);
    sleep(20);
    _exit(0);
}
static long drop(int file) {
    errno = posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
    return errno ? -1 : 0;
}
/* Whoever waits at the first word of a file that processes share waits at a word of ours then. */
static long take_waiter(void) {
    const void *shared = mmap(0, 4096, PROT_READ, MAP_SHARED, open(at("shared"), O_RDONLY), 0);
    return shared == MAP_FAILED ? -1 : syscall(SYS_futex, shared, FUTEX_REQUEUE, 0, 1L, &own_word, 0);
}
static long connect_to(int type, int port) {
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return connect(socket(AF_INET, type, 0), (struct sockaddr *)&address, sizeof address);
}
static long send_datagram(void) {
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)udp_port)};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return sendto(socket(AF_INET, SOCK_DGRAM, 0), "x", 1, 0, (struct sockaddr *)&address, sizeof address);
}
static long abstract_socket(int connects) {
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    snprintf(address.sun_path + 1, sizeof address.sun_path - 1, "%s%s", own_name, connects ? "" : "2");
    const size_t size = offsetof(struct sockaddr_un, sun_path) + 1 + strlen(address.sun_path + 1);
    const int own = socket(AF_UNIX, SOCK_STREAM, 0);
    return (connects ? connect : bind)(own, (struct sockaddr *)&address, (socklen_t)size);
}
static long larger_pipe(void) {
    int ends[2];
    return pipe(ends) != 0 ? -1 : fcntl(ends[0], F_SETPIPE_SZ, 1 << 20);
}
static long vmsplice_out(void) {
    int ends[2];
    return pipe(ends) != 0 ? -1 : vmsplice(ends[1], &mine, 1, 0);
}

#define ATTEMPT(name, fact, expression) {name, fact},
static const char *const names[][2] = {
#include "attempts.inc"
};
#undef ATTEMPT

static long attempt(size_t index) {
    size_t number = 0;
#define ATTEMPT(name, fact, expression) \
    if (index == number++) return (long)(expression);
#include "attempts.inc"
    return -1;
}

static size_t add_file(char *text, size_t size, size_t used, const char *path) {
    const int file = open(path, O_RDONLY);
    const ssize_t count = file < 0 ? 0 : read(file, text + used, size - used - 1);
    if (file >= 0) close(file);
    return used + (size_t)(count > 0 ? count : 0);
}

/* What the kernel shows of this process that an attempt may have changed. */
static uint64_t state_inside(void) {
    static char text[1 << 16];
    static const char *const files[] = {"personality", "limits", "timerslack_ns", "coredump_filter"};
    static const char *const links[] = {"user", "mnt", "net", "pid_for_children", "ipc", "uts", "cgroup"};
    char path[64];
    size_t used = 0;
    memset(text, 0, sizeof text);
    for (size_t i = 0; i < sizeof files / sizeof *files; ++i) {
        snprintf(path, sizeof path, "/proc/self/%s", files[i]);
        used = add_file(text, sizeof text, used, path);
    }
    for (size_t i = 0; i < sizeof links / sizeof *links; ++i) {
        snprintf(path, sizeof path, "/proc/self/ns/%s", links[i]);
        const ssize_t count = readlink(path, text + used, 64);
        used += (size_t)(count > 0 ? count : 0);
    }
    for (int number = 0; number < 256; ++number) { /* special files: sockets and such, not what was read */
        snprintf(path, sizeof path, "/proc/self/fd/%d", number);
        const ssize_t count = readlink(path, text + used, 64);
        if (count > 0 && (strncmp(text + used, "anon", 4) == 0 || strncmp(text + used, "socket", 6) == 0 ||
                          strncmp(text + used, "/memfd", 6) == 0))
            used += (size_t)count;
    }
    char status[4096] = "";
    add_file(status, sizeof status, 0, "/proc/self/status");
    for (char *rest = status, *one; (one = strsep(&rest, "\n")) != 0;)
        if (strncmp(one, "Cap", 3) == 0 || strncmp(one, "Uid", 3) == 0 || strncmp(one, "Sec", 3) == 0 ||
            strncmp(one, "Gid", 3) == 0 || strncmp(one, "NoNew", 5) == 0 || strncmp(one, "Threads", 7) == 0)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s", one);
    used += (size_t)snprintf(text + used, sizeof text - used, "%d", prctl(PR_GET_DUMPABLE));
    uint64_t hash = 14695981039346656037ull; /* FNV-1a */
    for (size_t i = 0; i < used; ++i) hash = (hash ^ (unsigned char)text[i]) * 1099511628211ull;
    return hash;
}

static void try_one(size_t index) {
    memset(got, 0, sizeof got);
    const uint64_t before = state_inside();
    errno = 0;
    const long result = attempt(index);
    const int reason = errno;
    got[sizeof got - 1] = 0;
    for (char *c = got; *c; ++c)
        if (*c < ' ' || *c > '~' || *c == '|') *c = '.';
    printf("attempt|%s|%s|%ld|%d|%d|%s\n", names[index][0], names[index][1], result, result < 0 ? reason : 0,
           before != state_inside(), got);
    fflush(stdout);
}

static void try_all(int is_alone) {
    FILE *file = fopen(at("outside"), "r");
    unsigned long address = 0;
    if (!file || fscanf(file, "%d %d %lx %d %d %63s", &victim, &file_number, &address, &tcp_port, &udp_port,
                        own_name) != 6)
        return;
    fclose(file);
    key = atoi(own_name + 2);
    mine = (struct iovec){got, 32};
    theirs = (struct iovec){(void *)(uintptr_t)address, 32};
    cpu_set_t all;
    sched_getaffinity(0, sizeof all, &all);
    CPU_ZERO(&last_cpu);
    for (int cpu = CPU_SETSIZE - 1; cpu >= 0 && CPU_COUNT(&last_cpu) == 0; --cpu)
        if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &last_cpu);
    for (size_t index = 0; index < sizeof names / sizeof *names; ++index) {
        if (!is_alone) {
            try_one(index);
            continue;
        }
        fflush(stdout);
        const pid_t child = fork();
        if (child == 0) alarm(5), try_one(index), _exit(0);
        int status = 0;
        waitpid(child, &status, 0);
        if (status != 0) /* it became another program, or hangs in the kernel */
            printf("attempt|%s|%s|%d|0|0|status %d\n", names[index][0], names[index][1], -1, status);
    }
    puts("all");
    fflush(stdout);
}

/* Threads that are there at once, as the kernel counts them, of `wanted` that so many threads start. */
static pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
static void *pass_gate(void *nothing) {
    pthread_mutex_lock(&gate);
    pthread_mutex_unlock(&gate);
    return nothing;
}
static void *start_threads(void *wanted) {
    pthread_attr_t small;
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, 16384);
    pthread_attr_setdetachstate(&small, PTHREAD_CREATE_DETACHED);
    for (int i = *(int *)wanted; i > 0; --i) {
        pthread_t thread;
        if (pthread_create(&thread, &small, pass_gate, 0) != 0) break;
    }
    return 0;
}
static int threads(int starters, int wanted) {
    pthread_t starting[16];
    char status[4096] = "";
    int each = wanted / starters, count = 0;
    pthread_mutex_lock(&gate);
    for (int i = 0; i < starters; ++i) pthread_create(&starting[i], 0, start_threads, &each);
    for (int i = 0; i < starters; ++i) pthread_join(starting[i], 0);
    add_file(status, sizeof status, 0, "/proc/self/status");
    const char *line = strstr(status, "Threads:");
    if (line) count = atoi(line + 8);
    pthread_mutex_unlock(&gate);
    for (int waited = 0; waited < 2000; ++waited) { /* until they have ended */
        memset(status, 0, sizeof status);
        add_file(status, sizeof status, 0, "/proc/self/status");
        line = strstr(status, "Threads:");
        if (!line || atoi(line + 8) < 20) break;
        usleep(5000);
    }
    return count;
}

/* Megabytes that are held in descriptors. */
static int hidden_mb(void) {
    static char piece[65536];
    size_t taken = 0;
    const int file = (int)syscall(SYS_memfd_create, "m", 0);
    for (int i = 0; i < 1600 && write(file, piece, sizeof piece) > 0; ++i) taken += sizeof piece;
    for (int i = 0, ends[2]; i < 400 && pipe2(ends, O_NONBLOCK) == 0; ++i)
        for (ssize_t count; (count = write(ends[1], piece, 4096)) > 0;) taken += (size_t)count;
    return (int)(taken >> 20);
}
/* Megabytes that malloc gives, a hundred at a time, up to two thousand. */
static int malloc_mb(void) {
    char *pieces[20];
    int count = 0;
    for (; count < 20 && (pieces[count] = malloc(100u << 20)) != 0; ++count)
        memset(pieces[count], 1, 100u << 20);
    for (int i = 0; i < count; ++i) free(pieces[i]);
    return 100 * count;
}

static void try_limits(void) {
    printf("limit|malloc|%d\n", malloc_mb());
    printf("limit|some threads|%d\n", threads(1, 256));
    printf("limit|threads|%d\n", threads(1, 3000));
    printf("limit|threads at once|%d\n", threads(16, 3000));
    printf("limit|input|%ld\n", read_at(at("f0"), 0));
    printf("limit|hidden|%d\n", hidden_mb());
    fflush(stdout);
}

static aftershade_status prepare(const aftershade_instance *instance, const aftershade_frame *frame,
                                 const aftershade_output *output) {
    const float gain = 1;
    const char *home = getenv("HOME");
    (void)instance, (void)frame;
    snprintf(folder, sizeof folder, "%s", home ? home : "");
    if (access(at("outside"), R_OK) == 0) try_all(getenv("ALONE") != 0);
    else try_limits();
    return output->set_float(output, "gain", &gain, 1);
}

static void destroy(const aftershade_instance *instance) { (void)instance; }

static const aftershade_instance the_instance = {
    .struct_size = sizeof(aftershade_instance), .destroy = destroy, .prepare = prepare};

static const aftershade_instance *create(const aftershade_factory *factory, const aftershade_host *host,
                                         const char *step) {
    (void)factory, (void)host, (void)step;
    return &the_instance;
}

static const aftershade_factory the_factory = {.struct_size = sizeof(aftershade_factory),
                                               .effect_id = "attempts",
                                               .effect_version = "1.0.0",
                                               .create = create};

static const aftershade_factory *get_factory(uint32_t index) {
    (void)index;
    return &the_factory;
}

const aftershade_library AFTERSHADE_LIBRARY_ENTRY = {.struct_size = sizeof(aftershade_library),
                                                     .abi_major = AFTERSHADE_ABI_MAJOR,
                                                     .abi_minor = AFTERSHADE_ABI_MINOR,
                                                     .name = "attempts",
                                                     .version = "1.0.0",
                                                     .factory_count = 1,
                                                     .get_factory = get_factory};
