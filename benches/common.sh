# Sourced by the scripts beside it.

# Coefficients of a small congruential generator around a mean, as little-endian doubles.
surface() { # SIZE MEAN SEED
  awk -v n="$1" -v mean="$2" -v x="$3" 'BEGIN {
    for (k = 0; k < n * n; k++) { x = (x * 16807) % 2147483647; printf "%.17g\n", mean * (0.9 + 0.2 * x / 2147483647) }
  }' | perl -ne 'print pack("d<", $_)'
}

# Processor time that all programs have taken since the machine started, in ticks.
busy() { awk '/^cpu / { print $2 + $3 + $4 + $7 + $8 + $9 }' /proc/stat; }

# Appends paragraphs to the section of a machine, the file $section.
say() { printf '%s\n' "$@" | fold -s -w 110 | sed 's/ *$//' >> "$section"; }
# Appends a table in Markdown, of lines whose columns a tab separates.
table() { awk -F '\t' '{ gsub("\t", " | "); print "| " $0 " |" } NR == 1 { gsub("[^|]+", "---"); print "|" $0 "|" }' >> "$section"; }

has() { grep -qw "$1" /proc/cpuinfo; }
# Name of this machine's processor, with the widest vectors that it has.
processor() {
  local width="no AVX2"
  if has avx512f; then width=AVX-512; elif has avx2; then width=AVX2; fi
  field() { awk -F ': *' -v key="$1" '$1 ~ "^" key "[ \t]*$" { print $2; exit }' /proc/cpuinfo; }
  echo "$(field 'model name'), family $(field 'cpu family'), model $(field model), $width"
}

# Writes $section into the page of performance as the section NAME, from its marker to the next.
write_section() { # NAME
  local page=docs/performance.md written
  written=$(mktemp)
  awk -v name="$1" -v file="$section" '
    function write_section(  line) { while ((getline line < file) > 0) print line; written = 1 }
    $0 == "<!-- machine: " name " -->" { print; print ""; print "### " name; print ""; write_section(); print ""; skipping = 1; next }
    /^<!-- (machine: .*|end of machines) -->$/ {
      skipping = 0
      if ($0 ~ /end of machines/ && !written) {
        print "<!-- machine: " name " -->"; print ""; print "### " name; print ""
        write_section()
        print ""
      }
    }
    !skipping { print }' "$page" > "$written"
  cat "$written" > "$page"
  rm "$written"
  echo "$page has the section \"$1\""
}
