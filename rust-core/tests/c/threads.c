/* One sea used by many threads at once: every thread gets, bit for bit, what a single one gets. */
#include "prob_water.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 8, ROWS = 512, ROUNDS = 4 };

/* What one thread computes, and from what. */
struct results {
    double f[ROWS], pdf[ROWS], drawn[3 * ROWS], drawn_pdf[ROWS], drawn_f[ROWS];
    float single[ROWS];
};

struct work {
    const struct ProbWater *sea;
    const struct results *expected;
    int differs;
};

static double to_source[3 * ROWS], to_observer[3 * ROWS], uniforms[3 * ROWS];
static float source32[3 * ROWS], observer32[3 * ROWS];

/* Returns 0 if every call succeeded. */
static int compute(const struct ProbWater *sea, struct results *to) {
    return prob_water_eval(sea, ROWS, to_source, to_observer, NULL, to->f)
        || prob_water_eval_f32(sea, ROWS, source32, observer32, NULL, to->single)
        || prob_water_pdf(sea, ROWS, to_source, to_observer, NULL, to->pdf)
        || prob_water_sample(sea, ROWS, to_source, uniforms, to->drawn, to->drawn_pdf, to->drawn_f);
}

static void *worker(void *argument) {
    struct work *work = argument;
    struct results *found = malloc(sizeof *found);
    double nowhere[3] = {2, 0, 0}, f;
    int round;

    for (round = 0; found && round < ROUNDS && !work->differs; round++) {
        memset(found, 0, sizeof *found);
        work->differs = compute(work->sea, found) || memcmp(found, work->expected, sizeof *found) != 0;
        /* A refusal has its message in its own thread only. */
        if (prob_water_eval(work->sea, 1, nowhere, nowhere, NULL, &f) != PROB_WATER_STATUS_ROW
            || strstr(prob_water_last_error(), "row 1") == NULL)
            work->differs = 1;
    }
    free(found);
    return NULL;
}

/* A direction of the upper hemisphere, by a generator that is the same everywhere. */
static void direction(unsigned *state, double *v) {
    double z, phi;
    *state = *state * 1664525u + 1013904223u;
    z = (*state >> 8) / 16777216.0;
    *state = *state * 1664525u + 1013904223u;
    phi = (*state >> 8) / 16777216.0 * 6.283185307179586;
    v[0] = sqrt(1 - z * z) * cos(phi);
    v[1] = sqrt(1 - z * z) * sin(phi);
    v[2] = z;
}

static int run(const char *surface) {
    struct ProbWaterOptions *options = prob_water_options_new();
    struct ProbWater *sea = NULL;
    struct results *expected = calloc(1, sizeof *expected);
    struct work work[THREADS];
    pthread_t threads[THREADS];
    int i, differs = 0;

    if (!expected || prob_water_options_set(options, "surface", surface)
        || prob_water_options_set(options, "friction_velocity", "24")
        || prob_water_options_set(options, "footprint", "0.15") || prob_water_configure(options, &sea)
        || compute(sea, expected)) {
        printf("FAILED: %s: %s\n", surface, prob_water_last_error());
        return 1;
    }
    prob_water_options_free(options);
    for (i = 0; i < THREADS; i++) {
        work[i].sea = sea;
        work[i].expected = expected;
        work[i].differs = 0;
        if (pthread_create(&threads[i], NULL, worker, &work[i])) {
            printf("FAILED: no thread could be started\n");
            exit(1);
        }
    }
    for (i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
        differs |= work[i].differs;
    }
    prob_water_free(sea);
    free(expected);
    if (differs)
        printf("FAILED: %s: a thread got other results than a single one\n", surface);
    return differs;
}

int main(void) {
    unsigned state = 1;
    int i, failed;

    for (i = 0; i < ROWS; i++) {
        direction(&state, to_source + 3 * i);
        direction(&state, to_observer + 3 * i);
    }
    for (i = 0; i < 3 * ROWS; i++) {
        state = state * 1664525u + 1013904223u;
        uniforms[i] = (state >> 8) / 16777216.0;
        source32[i] = (float)to_source[i];
        observer32[i] = (float)to_observer[i];
    }
    failed = run("flat") + run("empirical");
    if (!failed)
        printf("C interface: %d threads agree\n", THREADS);
    return failed != 0;
}
