# Prints the functions that public headers declare, one a line. A name is the word before the first
# parenthesis of a prototype, after comments are cut out.
{ text = text " " $0 "\n" }
END {
  while ((start = index(text, "/*")) > 0) {
    rest = substr(text, start + 2)
    text = substr(text, 1, start - 1) substr(rest, index(rest, "*/") + 2)
  }
  count = split(text, line, "\n")
  for (i = 1; i <= count; i++)
    if (line[i] ~ /^ (const |unsigned )*[a-z][a-z_0-9]* \**dvi_[a-z_0-9]+\(/) {
      name = line[i]
      sub(/\(.*/, "", name)
      sub(/.*[ *]/, "", name)
      print name
    }
}
