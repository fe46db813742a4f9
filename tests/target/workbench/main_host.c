/*
 * The workbench on the host: workbench WIDTH HEIGHT DISPARITIES, the same AES source.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdio.h>
#include <stdlib.h>

#include "tsr/hal/mps2_aes.h"
#include "workbench.h"

const struct tsr_aes_ops *const workbench_aes = &tsr_mps2_aes;

_Noreturn void workbench_fail(const char *what)
{
    fprintf(stderr, "workbench: %s\n", what);
    exit(2);
}

void workbench_load(const char *name, uint8_t *bytes, size_t len)
{
    FILE *file = fopen(name, "rb");
    workbench_expect(file != NULL && fread(bytes, 1, len, file) == len, name);
    fclose(file);
}

void workbench_store(const char *name, const void *bytes, size_t len)
{
    FILE *file = fopen(name, "wb");
    workbench_expect(file != NULL && fwrite(bytes, 1, len, file) == len && fclose(file) == 0, name);
}

int main(int argc, char **argv)
{
    workbench_expect(argc == 4, "give WIDTH HEIGHT DISPARITIES");
    struct workbench_case bench;
    bench.width = (uint16_t)atoi(argv[1]);
    bench.height = (uint16_t)atoi(argv[2]);
    bench.disparities = (uint16_t)atoi(argv[3]);
    workbench_run(&bench);
    return 0;
}
