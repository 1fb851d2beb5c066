# Make completions for bash or zsh of what the commands print for --help.
# Usage: for c in $commands; do dvi $c --help; done | awk -v shell=bash -f completions.awk

# Tells what completes a value: files, methods, problems, or nothing.
function kind_of(value) {
  if (value ~ /FILE|\.html$|^-\|/) return "files"
  if (value == "SCENE") return "problems"
  return value == "SPEC" ? "methods" : "nothing"
}

# Tells whether an option takes all words up to the next option.
function is_list(value) { return value ~ /\.\.\.$/ }

/^Usage: dvi / && $3 != command {
  command = $3
  commands = commands (commands == "" ? "" : " ") command
  summary[command] = ""
  operand[command] = $4
  next
}

# The summary is the first paragraph.
command != "" && !summed[command] {
  if (NF && !/^ /) summary[command] = summary[command] (summary[command] == "" ? "" : " ") $0
  else summed[command] = summary[command] != ""
}

/^Options:$/ { rows = 1; next }
!NF { rows = 0 }

rows && /^  --/ {
  name = $1
  has_value = substr($0, 26, 1) != " " || substr($0, 1, 26) ~ /^ +[^ ]+ +[^ ]/
  count = ++options[command]
  option[command, count] = name
  value[command, count] = has_value ? $2 : ""
  help[command, count] = $0
  sub(/^ +[^ ]+ +/, "", help[command, count])
  if (has_value) sub(/^[^ ]+ +/, "", help[command, count])
}

function operands_of(command) {
  if (operand[command] ~ /PROBLEM/) return operand[command] ~ /FILE/ ? "runs" : "problems"
  if (operand[command] ~ /methods/) return "lists"
  return "files"
}

function first_sentence(text) {
  sub(/[.:;].*/, "", text)
  return text
}

function bash_script(   list, i, k, c, words, valued) {
  print "# Completion of dvi for bash, made from the options that each command explains by --help."
  print "_dvi_names() { \"${COMP_WORDS[0]}\" list \"$1\" --csv - 2>/dev/null | sed '1d; s/,.*//'; }"
  print "_dvi()\n{"
  print "  local word=${COMP_WORDS[COMP_CWORD]} last=${COMP_WORDS[COMP_CWORD-1]}"
  print "  local command=${COMP_WORDS[1]} options= operands=files values="
  print "  local option at=$((COMP_CWORD - 1))"
  print "  while [ \"$at\" -gt 1 ] && [ \"${COMP_WORDS[at]:0:2}\" != -- ]; do at=$((at - 1)); done"
  print "  option=${COMP_WORDS[at]}"
  print "  COMPREPLY=()"
  print "  if [ \"$COMP_CWORD\" -eq 1 ]; then"
  print "    COMPREPLY=($(compgen -W \"" commands " --help --version\" -- \"$word\"))"
  print "    return\n  fi"
  print "  case $command in"
  k = split(commands, list, " ")
  for (i = 1; i <= k; i++) {
    command = list[i]
    words = ""
    for (c = 1; c <= options[command]; c++) words = words " " option[command, c]
    print "  " command ")\n    options='" substr(words, 2) "' operands=" operands_of(command)
    print "    case $last in"
    for (c = 1; c <= options[command]; c++)
      if (value[command, c] != "")
        print "    " option[command, c] ") values=" kind_of(value[command, c]) " ;;"
    print "    esac"
    for (c = 1; c <= options[command]; c++)
      if (is_list(value[command, c]))
        print "    [ \"$option\" = " option[command, c] " ] && [ \"${word:0:1}\" != - ] &&" \
          " values=" kind_of(value[command, c])
    print "    ;;"
  }
  print "  esac"
  print "  if [ -z \"$values\" ] && [ \"${word:0:1}\" = - ]; then"
  print "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))"
  print "    return\n  fi"
  print "  case ${values:-$operands} in"
  print "  files) COMPREPLY=($(compgen -f -- \"$word\")) ;;"
  print "  methods) COMPREPLY=($(compgen -W \"$(_dvi_names methods)\" -- \"$word\")) ;;"
  print "  problems) COMPREPLY=($(compgen -f -X '!*.y*ml' -- \"$word\")" \
    " $(compgen -W \"$(_dvi_names problems)\" -- \"$word\")) ;;"
  print "  runs) COMPREPLY=($(compgen -f -- \"$word\")" \
    " $(compgen -W \"$(_dvi_names problems)\" -- \"$word\")) ;;"
  print "  lists) COMPREPLY=($(compgen -W 'methods problems' -- \"$word\")) ;;"
  print "  esac\n}"
  print "complete -o filenames -F _dvi dvi"
}

# Quote for zsh's _arguments, inside of single quotes.
function quoted(text) {
  gsub(/\\/, "\\\\", text)
  gsub(/\[|\]|:/, "\\\\&", text)
  gsub(/'/, "'\\''", text)
  return text
}

function zsh_action(kind) {
  if (kind == "files") return "_files"
  if (kind == "methods" || kind == "problems") return "{_dvi_names " kind "}"
  if (kind == "runs") return "{_dvi_names problems; _files}"
  return kind == "lists" ? "(methods problems)" : " "
}

function zsh_script(   list, i, k, c, repeats) {
  print "#compdef dvi"
  print "# Completion of dvi for zsh, made from the options that each command explains by --help."
  print "_dvi_names() {"
  print "  compadd -- ${(f)\"$(dvi list $1 --csv - 2>/dev/null | sed '1d; s/,.*//')\"}"
  print "  [[ $1 == methods ]] || _files -g '*.y(a|)ml'\n}"
  print "_dvi() {"
  print "  if (( CURRENT == 2 )); then\n    local -a commands=("
  k = split(commands, list, " ")
  for (i = 1; i <= k; i++) print "      '" list[i] ":" quoted(first_sentence(summary[list[i]])) "'"
  print "    )\n    _describe command commands\n    return\n  fi"
  print "  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $command in"
  for (i = 1; i <= k; i++) {
    command = list[i]
    print "  " command ")\n    _arguments \\"
    for (c = 1; c <= options[command]; c++) {
      repeats = help[command, c] ~ /repeated|several/ ? "*" : ""
      printf "      '%s%s[%s]", repeats, option[command, c], quoted(help[command, c])
      if (value[command, c] != "")
        printf ":%s%s:%s", is_list(value[command, c]) ? "*--*:" : "", quoted(value[command, c]),
          zsh_action(kind_of(value[command, c]))
      print "' \\"
    }
    print "      '1:" quoted(operand[command]) ":" zsh_action(operands_of(command)) "'\n    ;;"
  }
  print "  esac\n}"
  print "_dvi \"$@\""
}

END { if (shell == "zsh") zsh_script(); else bash_script() }
