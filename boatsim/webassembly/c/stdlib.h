/* Functions of the C library's stdlib.h that a translated program calls. */
#ifndef BOATSIM_STDLIB_H
#define BOATSIM_STDLIB_H

#include <stddef.h>

void *calloc(size_t count, size_t size);
void free(void *block);

#endif
