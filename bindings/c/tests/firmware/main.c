/* The same in an emulated Cortex-M, through the archive and the header alone: reads cylinder.bin and log.raw (rows of time and three readings
 * as doubles), restores in the middle, writes rows.raw and state.raw. Files are those of the host, by semihosting. */
#include "cylwatch.h"

enum { OPEN = 0x01, WRITE0 = 0x04, WRITE = 0x05, READ = 0x06, EXIT = 0x20, READING = 1, WRITING = 5, CELLS = 4 };

static unsigned char arenas[2][1100 << 10];
static unsigned char blob[16 << 10], state[64 << 10];
static double cells[10000][CELLS];

static uintptr_t host(uintptr_t what, const void *arguments) {
    register uintptr_t r0 __asm__("r0") = what;
    register const void *r1 __asm__("r1") = arguments;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static void leave(uintptr_t code) {
    const uintptr_t arguments[] = {0x20026, code};
    for (;;)
        host(EXIT, arguments);
}

static uintptr_t opened(const char *name, uintptr_t mode, uintptr_t length) {
    const uintptr_t arguments[] = {(uintptr_t)name, mode, length};
    return host(OPEN, arguments);
}

static size_t read_all(uintptr_t file, void *to, size_t size) {
    const uintptr_t arguments[] = {file, (uintptr_t)to, size};
    return size - host(READ, arguments);
}

static void write_all(uintptr_t file, const void *from, size_t size) {
    const uintptr_t arguments[] = {file, (uintptr_t)from, size};
    host(WRITE, arguments);
}

static void say(const char *what, unsigned long number) {
    char digits[12];
    char *at = digits + sizeof digits;
    *--at = '\0';
    *--at = '\n';
    do
        *--at = (char)('0' + number % 10);
    while ((number /= 10) != 0);
    host(WRITE0, what);
    host(WRITE0, at);
}

void cw_panicked(void) {
    host(WRITE0, "panicked\n");
    leave(3);
}

static void check(cw_code code, cw_handle *handle) {
    char detail[CW_TEXT_SIZE] = "";
    if (code == CW_OK || code == CW_NO_ROW)
        return;
    if (handle != NULL)
        cw_detail(handle, detail, sizeof detail);
    host(WRITE0, cw_error_text(code));
    host(WRITE0, "\n");
    host(WRITE0, detail);
    host(WRITE0, "\n");
    leave(2);
}

static void write_rows(cw_code code, cw_handle *handle, cw_output *row, uintptr_t out) {
    for (; code == CW_OK; code = cw_next(handle, row))
        write_all(out, row, sizeof *row);
    check(code, handle);
}

static void replay(void) {
    const size_t blob_size = read_all(opened("cylinder.bin", READING, 12), blob, sizeof blob);
    const size_t rows = read_all(opened("log.raw", READING, 7), cells, sizeof cells) / sizeof cells[0];
    const uintptr_t out = opened("rows.raw", WRITING, 8);
    size_t state_size;
    cw_handle *handle = NULL;
    cw_output output;
    cw_memory memory;
    check(cw_init(arenas[0], sizeof arenas[0], blob, blob_size, &handle), handle);
    for (size_t row = 0; row < rows; row++) {
        if (row == rows / 2) {
            check(cw_save(handle, state, sizeof state, &state_size), handle);
            check(cw_memory_of(handle, &memory), handle);
            say("bytes of the arena that were reached ", memory.reached_bytes);
            check(cw_restore(arenas[1], sizeof arenas[1], blob, blob_size, state, state_size, &handle), handle);
        }
        write_rows(cw_step(handle, cells[row][0], cells[row] + 1, CELLS - 1, &output), handle, &output, out);
    }
    write_rows(cw_finish(handle, &output), handle, &output, out);
    check(cw_save(handle, state, sizeof state, &state_size), handle);
    write_all(opened("state.raw", WRITING, 9), state, state_size);
}

extern uint32_t data_start, data_end, data_from, bss_start, bss_end, stack_top;

void reset(void) {
    volatile uint32_t *const coprocessors = (volatile uint32_t *)0xe000ed88;
    /* Floating point is off after a reset. */
    *coprocessors |= UINT32_C(0xf) << 20;
    __asm__ volatile("dsb\n\tisb");
    for (volatile uint32_t *to = &data_start, *from = &data_from; to < &data_end;)
        *to++ = *from++;
    for (volatile uint32_t *to = &bss_start; to < &bss_end;)
        *to++ = 0;
    replay();
    leave(0);
}

__attribute__((section(".vectors"), used)) static const void *const vectors[] = {&stack_top, (const void *)reset};
