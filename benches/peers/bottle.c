/* The closed bottle by CVODE (BDF, dense, difference quotients), compiled: what scipy and CasADi are compared with, too.
 *
 * bottle FILE: numbers in the order of `c_rows` in case_integrators.py; prints one JSON object per tolerance. */
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <time.h>

enum { ITERATIONS = 3, REPETITIONS = 40 };
static const double FIRST_STEP_S = 0.1;

typedef struct {
    int cells, faces, terms, rows, columns;
    double *capacity, *conduction, *supply, *inner_cell, *inner_area, *inner_conductance, *temperature, *film;
    double middle_k, half_k, energy_middle, energy_half, scale, factor, flat, duration_s, sample_s;
    double *start;
} Bottle;

static FILE *file;

static double number(void) {
    double value;
    if (fscanf(file, "%lf", &value) != 1) {
        fputs("the file ends too early\n", stderr);
        exit(2);
    }
    return value;
}

static double *numbers(int count) {
    double *values = malloc(sizeof(double) * (size_t)count);
    for (int i = 0; i < count; i++) values[i] = number();
    return values;
}

static double polynomial(const double *coefficients, int terms, double x) {
    double value = 0.0;
    for (int k = terms - 1; k >= 0; k--) value = value * x + coefficients[k];
    return value;
}

static int rate(sunrealtype t, N_Vector state, N_Vector out, void *data) {
    (void)t;
    const Bottle *b = data;
    const double *y = N_VGetArrayPointer(state);
    double *dy = N_VGetArrayPointer(out);
    double film[16], total = 0.0;
    double unit = polynomial(b->temperature, b->terms, (y[b->cells] - b->energy_middle) / b->energy_half);
    double gas = b->middle_k + b->half_k * unit;
    for (int i = 0; i < b->rows; i++) film[i] = polynomial(b->film + i * b->columns, b->columns, unit);
    for (int i = 0; i < b->cells; i++) {
        double flow = b->supply[i];
        for (int j = 0; j < b->cells; j++) flow += b->conduction[i * b->cells + j] * y[j];
        dy[i] = flow;
    }
    for (int f = 0; f < b->faces; f++) {
        int cell = (int)b->inner_cell[f];
        double node = y[cell], surface = node, g = b->inner_conductance[f];
        for (int k = 0; k < ITERATIONS; k++) {
            double theta = surface - gas, square = theta * theta + b->flat * b->flat;
            double at = (0.5 * (surface + gas) - b->middle_k) / b->half_k;
            double coefficient =
                b->inner_area[f] * b->factor * exp(polynomial(film, b->rows, at)) * pow(square, 1.0 / 6.0);
            double slope = coefficient * (1.0 + theta * theta / (3.0 * square));
            surface += (g * (node - surface) - coefficient * theta) / (g + slope);
        }
        dy[cell] -= g * (node - surface);
        total += g * (node - surface);
    }
    for (int i = 0; i < b->cells; i++) dy[i] /= b->capacity[i];
    dy[b->cells] = total / b->scale;
    return 0;
}

/* One run; energies at the samples go to `energy`. Returns steps and calls of the right-hand side. */
static void run(Bottle *b, SUNContext context, double tolerance, double *energy, long *steps, long *rates) {
    int n = b->cells + 1, count = (int)lround(b->duration_s / b->sample_s);
    N_Vector y = N_VNew_Serial(n, context);
    for (int i = 0; i < n; i++) N_VGetArrayPointer(y)[i] = b->start[i];
    SUNMatrix matrix = SUNDenseMatrix(n, n, context);
    SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
    void *memory = CVodeCreate(CV_BDF, context);
    CVodeInit(memory, rate, 0.0, y);
    CVodeSStolerances(memory, tolerance, 100.0 * tolerance);
    CVodeSetUserData(memory, b);
    CVodeSetLinearSolver(memory, solver, matrix);
    CVodeSetInitStep(memory, FIRST_STEP_S);
    CVodeSetMaxNumSteps(memory, 100000);
    CVodeSetStopTime(memory, b->duration_s);
    energy[0] = b->start[n - 1];
    for (int k = 1; k <= count; k++) {
        sunrealtype t;
        if (CVode(memory, k * b->sample_s, y, &t, CV_NORMAL) < 0) exit(3);
        energy[k] = N_VGetArrayPointer(y)[n - 1];
    }
    long differences = 0;
    CVodeGetNumSteps(memory, steps);
    CVodeGetNumRhsEvals(memory, rates);
    CVodeGetNumLinRhsEvals(memory, &differences);
    *rates += differences;
    CVodeFree(&memory);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(y);
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(int argc, char **argv) {
    if (argc != 2 || !(file = fopen(argv[1], "r"))) return 2;
    Bottle b;
    b.cells = (int)number();
    b.faces = (int)number();
    b.terms = (int)number();
    b.rows = (int)number();
    b.columns = (int)number();
    if (b.rows > 16) return 2;
    b.capacity = numbers(b.cells);
    b.conduction = numbers(b.cells * b.cells);
    b.supply = numbers(b.cells);
    b.inner_cell = numbers(b.faces);
    b.inner_area = numbers(b.faces);
    b.inner_conductance = numbers(b.faces);
    b.temperature = numbers(b.terms);
    b.film = numbers(b.rows * b.columns);
    double *scalars[] = {&b.middle_k, &b.half_k, &b.energy_middle, &b.energy_half, &b.scale,
                         &b.factor,   &b.flat,   &b.duration_s,    &b.sample_s};
    for (int i = 0; i < 9; i++) *scalars[i] = number();
    b.start = numbers(b.cells + 1);
    int tolerances = (int)number(), count = (int)lround(b.duration_s / b.sample_s);
    double *energy = malloc(sizeof(double) * (size_t)(count + 1)), times[REPETITIONS];
    SUNContext context;
#if SUNDIALS_VERSION_MAJOR >= 7
    SUNContext_Create(SUN_COMM_NULL, &context);
#else
    SUNContext_Create(NULL, &context);
#endif
    for (int k = 0; k < tolerances; k++) {
        double tolerance = number();
        long steps = 0, rates = 0;
        for (int i = 0; i < REPETITIONS; i++) {
            struct timespec from, to;
            int calls = b.cells > 1 ? 4 : 40;
            clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
            for (int call = 0; call < calls; call++) run(&b, context, tolerance, energy, &steps, &rates);
            clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
            times[i] = ((double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec)) / calls;
        }
        qsort(times, REPETITIONS, sizeof(double), ascending);
        printf("%s{\"version\": \"%s\", \"tolerance\": %.17g, \"steps\": %ld, \"rates\": %ld,\n", k ? ",\n" : "[",
               SUNDIALS_VERSION, tolerance, steps, rates);
        printf("\"time\": {\"minimum_s\": %.17g, \"lower_s\": %.17g, \"median_s\": %.17g, \"upper_s\": %.17g, \"repetitions\": %d},\n",
               times[0], times[REPETITIONS / 4], times[REPETITIONS / 2], times[3 * REPETITIONS / 4], REPETITIONS);
        printf("\"energy\": [");
        for (int i = 0; i <= count; i++) printf("%s%.17g", i ? ", " : "", energy[i]);
        printf("]}");
    }
    puts("]");
    return 0;
}
