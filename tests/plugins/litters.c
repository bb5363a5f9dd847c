/* For LD_PRELOAD: writes a file of the name LITTER beside the frames of the run that it is loaded into. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

__attribute__((constructor)) static void litter(void) {
    const char *name = getenv("LITTER");
    static char words[65536];
    char path[4096];
    if (!name) return;
    FILE *file = fopen("/proc/self/cmdline", "rb");
    const size_t size = file ? fread(words, 1, sizeof words - 1, file) : 0;
    if (file) fclose(file);
    for (const char *word = words; word < words + size; word += strlen(word) + 1) {
        if (strcmp(word, "-o") != 0) continue;
        const char *frames = word + strlen(word) + 1;
        const char *slash = strrchr(frames, '/');
        if (!slash) return;
        snprintf(path, sizeof path, "%.*s/%s", (int)(slash - frames), frames, name);
        FILE *written = fopen(path, "wb");
        if (written) fclose(written);
    }
}
