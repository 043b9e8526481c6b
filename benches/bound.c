/* What the arithmetic of a step takes at least on this processor.

       gcc -O2 -march=native -o bound bound.c && ./bound OPERATIONS

   OPERATIONS: multiplications, additions, comparisons and selections for eight blocks, of eight numbers each. Prints the clock, by a chain of
   additions of integers of a cycle each; multiplications and additions of whole vectors that begin in a cycle; cycles of the square root and
   the division of eight numbers; and what a step takes at least for these. */

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#ifdef __AVX512F__
#define LANES 8
#define REGISTER "zmm"
#elif defined __AVX__
#define LANES 4
#define REGISTER "ymm"
#else
#error "written for AVX and AVX-512"
#endif

#define ADD(n) "vaddpd %%" REGISTER #n ", %%" REGISTER #n ", %%" REGISTER #n "\n"
#define MULTIPLY(n) "vmulpd %%" REGISTER #n ", %%" REGISTER #n ", %%" REGISTER #n "\n"

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static double integer_chain(long n) {
  long x = 0;
  double began = now();
  for (long k = 0; k < n; k++) {
    __asm__ volatile("add $1, %0\n add $1, %0\n add $1, %0\n add $1, %0\n add $1, %0\n add $1, %0\n add $1, %0\n add $1, %0" : "+r"(x));
  }
  return (now() - began) / (8.0 * n);
}

/* Twelve chains: as many as it takes to hide how long each operation takes. Of zeros, which are neither infinite nor subnormal at any time. */
static double multiply_and_add(long n) {
  __asm__ volatile("vzeroall" ::: "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8", "xmm9", "xmm10", "xmm11");
  double began = now();
  for (long i = 0; i < n; i++) {
    __asm__ volatile(ADD(0) MULTIPLY(1) ADD(2) MULTIPLY(3) ADD(4) MULTIPLY(5) ADD(6) MULTIPLY(7) ADD(8) MULTIPLY(9) ADD(10) MULTIPLY(11)
                     ::: "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8", "xmm9", "xmm10", "xmm11");
  }
  return (now() - began) / (12.0 * n);
}

/* Square root and division of eight numbers. */
static double root_and_quotient(long n) {
  const double two[8] = {2, 2, 2, 2, 2, 2, 2, 2};
  double began = now();
  for (long i = 0; i < n; i++) {
    for (int k = 0; k < 8 / LANES; k++) {
      __asm__ volatile("vmovupd %0, %%" REGISTER "0\n vsqrtpd %%" REGISTER "0, %%" REGISTER "1\n vdivpd %%" REGISTER "0, %%" REGISTER
                       "0, %%" REGISTER "2" ::"m"(two) : "xmm0", "xmm1", "xmm2");
    }
  }
  return (now() - began) / n;
}

static double best(double (*of)(long), long n) {
  double least = 1e9;
  for (int round = 0; round < 20; round++) {
    double seconds = of(n);
    if (seconds < least) least = seconds;
  }
  return least;
}

int main(int count, char **arguments) {
  if (count != 2) {
    fprintf(stderr, "usage: bound OPERATIONS\n");
    return 2;
  }
  double operations = atof(arguments[1]) * 8 / LANES;
  double cycle = best(integer_chain, 200000);
  double each = best(multiply_and_add, 100000) / cycle;
  double roots = best(root_and_quotient, 20000) / cycle;
  double cycles = operations * each + roots;
  printf("%.2f GHz; %d numbers in a vector, %.1f operations a cycle; root and division of eight numbers %.0f cycles.\n", 1e-9 / cycle, LANES,
         1 / each, roots);
  printf("%s operations on eight numbers: at least %.0f cycles for eight blocks, %.2f ns a block.\n", arguments[1], cycles,
         cycles * cycle * 1e9 / 8);
}
