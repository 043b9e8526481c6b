// Sums that do not depend on the order of their terms: crates/slipfront/src/fixed_point.rs. A term is rounded to
// a multiple of a quantum, and the multiples are added up as integers.
#pragma once
#include "target.h"

// The power of two above a bound; NaN without a bound.
FN double limit_of(double bound) {
    i64 exponent = bits_of(larger(1e-270, bound)) & 0x7ff0000000000000LL;
    return bound <= 1e300 ? 2.0 * of_bits(exponent) : of_bits(0x7ff8000000000000LL);
}

// A number plus this has, in its bits, those of the shift plus the multiple of the quantum.
FN double shift_of(double limit) { return 3.0 * limit; }

FN i64 integer_of(double x, double shift) { return bits_of(x + shift) - bits_of(shift); }

// A sum of integers as two words, each of which is added up by itself: low + 2^40 high.
struct Words {
    i64 low, high;
};

FN Words words_of(i64 sum) {
    Words words = {sum & ((1LL << 40) - 1), sum >> 40};
    return words;
}

// A sum to which all threads of a lattice add numbers that are not negative. They find the largest number first, which
// sets the quantum: as integers, the bits of such numbers have the same order. All zero before the first number.
struct CommonSum {
    u64 largest, low, high;
};

// The double nearest to a sum, ties to even, as Rust converts an i128.
FN double double_of(Words words) {
    i64 high = words.high + (words.low >> 40);
    u64 low = (u64)(words.low & ((1LL << 40) - 1));
    bool is_negative = high < 0;
    // The magnitude as 128 bits, of two's complement.
    u64 top = (u64)(high >> 24), bottom = ((u64)high << 40) | low;
    if (is_negative) {
        bottom = ~bottom + 1;
        top = ~top + (bottom == 0);
    }
    double magnitude;
    if (top == 0) {
        magnitude = (double)bottom;
    } else {
        int zeros = __clzll((i64)top);
        u64 leading = zeros == 0 ? top : (top << zeros) | (bottom >> (64 - zeros));
        u64 rest = zeros == 0 ? bottom : bottom << zeros;
        // What is cut off decides ties alone.
        leading |= rest != 0;
        magnitude = (double)leading * of_bits((i64)(1023 + 64 - zeros) << 52);
    }
    return is_negative ? -magnitude : magnitude;
}

// The number that a sum stands for; 2^51 quanta make up the limit.
FN double value_of(Words sum, double limit) { return double_of(sum) * (limit / 2251799813685248.0); }

// The number that a common sum stands for, which is emptied.
FN double take_sum(CommonSum& sum) {
    Words words = {(i64)sum.low, (i64)sum.high};
    double value = value_of(words, limit_of(of_bits((i64)sum.largest)));
    sum.largest = sum.low = sum.high = 0;
    return value;
}

// Numbers of a range that may lie far from zero, as differences from its centre.
struct Window {
    double centre, limit;
};

// The nearest integer, ties away from zero. The difference is exact.
FN double rounded(double x) {
    double whole = trunc(x), rest = x - whole;
    return rest >= 0.5 ? whole + 1.0 : rest <= -0.5 ? whole - 1.0 : whole;
}

FN Window window_around(double low, double high) {
    Window window;
    window.limit = limit_of(larger(1e-9, high - low));
    double grid = window.limit / 8.0;
    window.centre = rounded((low + high) / 2.0 / grid) * grid;
    return window;
}

FN bool contains(Window window, double low, double high) {
    return window.centre + -1.0 * window.limit <= low && high <= window.centre + window.limit;
}
