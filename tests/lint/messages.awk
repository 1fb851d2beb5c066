# Prints the sentences of C sources: all string literals of two words or more, one a line, with <>
# for each value that a format fills in.
# Usage: awk -f messages.awk FILE...

FNR == 1 { text = text "\n" }
/^#/ { next }
{ text = text $0 "\n" }

# Formats and macros of formats, then neighbours without a word between them, become <>.
function sentence(s) {
  gsub(/%%/, "\001", s)
  gsub(/%[-+ #0-9.*]*[hlzjt]*[a-zA-Z]/, "<>", s)
  gsub(/\001/, "%", s)
  while (gsub(/<><>/, "<>", s)) continue
  gsub(/\\"/, "\"", s)
  gsub(/\\\\/, "\\", s)
  sub(/\\n$/, "", s)
  gsub(/^ +| +$/, "", s)
  return s
}

END {
  gsub(/"[ \n]*DVI__FOUND_FORMAT[ \n]*"/, "%s", text)
  inside = ""
  for (i = 1; i <= length(text); i++) {
    c = substr(text, i, 1)
    if (substr(text, i, 2) == "/*") { i += index(substr(text, i), "*/"); continue }
    if (c == "'") { i += substr(text, i + 1, 1) == "\\" ? 3 : 2; continue }
    if (c == "\"") {
      for (i++; (c = substr(text, i, 1)) != "\""; i++) {
        inside = inside c
        if (c == "\\") inside = inside substr(text, ++i, 1)
      }
      continue
    }
    if (c == " " || c == "\n") continue
    inside = sentence(inside)
    if (inside ~ /[^ ] +[^ ]*[a-z]/) print inside
    inside = ""
  }
}
