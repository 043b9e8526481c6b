# Sourced by the scripts beside it.

# Coefficients of a small congruential generator around a mean, as little-endian doubles.
surface() { # SIZE MEAN SEED
  awk -v n="$1" -v mean="$2" -v x="$3" 'BEGIN {
    for (k = 0; k < n * n; k++) { x = (x * 16807) % 2147483647; printf "%.17g\n", mean * (0.9 + 0.2 * x / 2147483647) }
  }' | perl -ne 'print pack("d<", $_)'
}

# Processor time that all programs have taken since the machine started, in ticks.
busy() { awk '/^cpu / { print $2 + $3 + $4 + $7 + $8 + $9 }' /proc/stat; }
