/* The memory of a program in a page. */

#define EXPORTED(name) __attribute__((export_name(name)))
#define PAGE 65536 /* [bytes] unit in which the memory grows */
#define ALIGNMENT 16

/* Memory: one stack above the data of the program. The translated functions free their arrays when
   they return, so that a freed block is above every block that is still in use. */
extern unsigned char __heap_base;
static uintptr_t top;

EXPORTED("allocate") void *allocate(size_t bytes) {
    if (top == 0) top = (uintptr_t)&__heap_base;
    uintptr_t begin = (top + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT, end = begin + bytes;
    size_t pages = __builtin_wasm_memory_size(0);
    if (end > pages * PAGE) {
        size_t missing = (end - pages * PAGE + PAGE - 1) / PAGE;
        if (__builtin_wasm_memory_grow(0, missing) == (size_t)-1) __builtin_trap();
    }
    top = end;
    return (void *)begin;
}

void *calloc(size_t count, size_t size) {
    unsigned char *block = allocate(count * size);
    for (size_t i = 0; i < count * size; i++) block[i] = 0;
    return block;
}

void free(void *block) {
    if (block != NULL && (uintptr_t)block < top) top = (uintptr_t)block;
}

void *memcpy(void *to, const void *from, size_t bytes) {
    for (size_t i = 0; i < bytes; i++) ((unsigned char *)to)[i] = ((const unsigned char *)from)[i];
    return to;
}

void *memset(void *to, int byte, size_t bytes) {
    for (size_t i = 0; i < bytes; i++) ((unsigned char *)to)[i] = (unsigned char)byte;
    return to;
}
