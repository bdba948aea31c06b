# SPDX-License-Identifier: Apache-2.0
# Small faults are put into a clone of HEAD, one at a time, and its tests are asked whether they find them. For `dev`
# to source, whose functions build and test.

# The clone is kept from run to run, so that its builds begin where the last one ended.
faulty=build/mutants
fault_logs=build/mutants-log # a file a fault
last_log=$fault_logs/last.log
fault_list=tests/mutants/faults.txt

# try_faults [--list | --check] [TEXT...]: of all faults, or of those whose sentence or file has one of the texts.
try_faults() {
  local mode='' i chosen=() verdicts=() took=() finders=()
  case ${1:-} in --list | --check) mode=$1 && shift ;; esac
  read_faults
  choose_faults "$@"
  case $mode in
    --list) for i in "${chosen[@]}"; do printf '%-40s  %s\n' "${files[i]}" "${sentences[i]}"; done ;;
    --check) check_faults . ;;
    *) run_faults ;;
  esac
}

# The list as sentences, files, olds and news. Each line of an old or new text ends in a line break.
read_faults() {
  local line is_first=1
  sentences=() files=() olds=() news=()
  while IFS= read -r line; do
    case $line in
      '#'*) ;;
      '') is_first=1 ;;
      '- '*) olds[-1]+=${line#- }$'\n' ;;
      '+ '*) news[-1]+=${line#+ }$'\n' ;;
      *)
        if ((is_first)); then
          sentences+=("$line") files+=('') olds+=('') news+=('')
          is_first=0
        else
          files[-1]=$line
        fi
        ;;
    esac
  done <"$fault_list"
}

# Into `chosen`.
choose_faults() {
  local i text
  for i in "${!sentences[@]}"; do
    (($#)) || chosen+=("$i")
    for text; do
      [[ ${sentences[i]} == *"$text"* || ${files[i]} == *"$text"* ]] && chosen+=("$i") && break
    done
  done
  ((${#chosen[@]})) || fail "no fault has one of these texts: $*"
}

# check_faults TREE: each old text stands there once, and no two faults are in one folder.
check_faults() {
  local i count folder bad=0
  declare -A seen=()
  for i in "${chosen[@]}"; do
    count=$(times_in "$1/${files[i]}" "${olds[i]}")
    folder=${files[i]%/*}
    ((count == 1)) || { printf '%s: the old text is there %d times\n' "${files[i]}" "$count" && bad=1; }
    [[ ${olds[i]} != "${news[i]}" ]] || { printf '%s: nothing is changed\n' "${files[i]}" && bad=1; }
    [[ -z ${seen[$folder]:-} ]] || { printf '%s: there is another fault in its folder\n' "${files[i]}" && bad=1; }
    seen[$folder]=1
  done
  ((!bad)) || fail "correct $fault_list"
  printf '%d faults, and each old text is there once\n' "${#chosen[@]}"
}

# text_of FILE: with a line break before it, so that whole lines can be looked for; an x keeps those at its end.
text_of() {
  printf '\n' && cat "$1" && printf x
}

# times_in FILE LINES
times_in() {
  local text count=0
  if [[ -n $2 && -f $1 ]]; then
    text=$(text_of "$1")
    while [[ $text == *$'\n'"$2"* ]]; do
      text=$'\n'${text#*$'\n'"$2"}
      count=$((count + 1))
    done
  fi
  printf '%d\n' "$count"
}

# put_in I: the fault, in the clone.
put_in() {
  local file=$faulty/${files[$1]} text
  text=$(text_of "$file")
  text=${text/$'\n'"${olds[$1]}"/$'\n'"${news[$1]}"}
  text=${text%x}
  printf '%s' "${text#$'\n'}" >"$file"
}

take_out() {
  git -C "$faulty" checkout --quiet -- .
}

in_clone() (
  cd "$faulty" && export CCACHE_BASEDIR=$PWD && "$@"
)

run_faults() {
  local i number=0 found=0 least=${#chosen[@]}
  phase 'clone of HEAD' clone_head
  check_faults "$faulty" >/dev/null
  install build
  phase 'build of HEAD' in_clone configure_and_make release
  mkdir -p "$fault_logs"
  for i in "${chosen[@]}"; do
    number=$((number + 1))
    try_fault "$i" "$fault_logs/$(printf '%02d' $((i + 1))).log"
    printf '%2d of %d  %s  %s: %s\n' "$number" "${#chosen[@]}" "$(verdict_of "$i")" "${files[i]}" \
      "${sentences[i]}" >&2
  done
  phase 'build without a fault' in_clone configure_and_make release
  doubt_finders
  printf '\n'
  for i in "${chosen[@]}"; do
    printf '%-40s %s\n' "${files[i]%/*}" "$(verdict_of "$i")"
    [[ ${verdicts[i]} != found ]] || found=$((found + 1))
  done
  printf '%d of %d found\n' "$found" "${#chosen[@]}"
  ((${#chosen[@]} < ${#sentences[@]})) || least=$((least - 1))
  [[ " ${verdicts[*]} " != *' broken '* ]] || fail "not all faults of $fault_list compile; $fault_logs says why"
  ((found >= least)) || fail "at least $least were to be found; $fault_logs has what was run"
}

clone_head() {
  if [[ ! -d $faulty/.git ]]; then git clone --quiet --no-checkout . "$faulty"; fi &&
    git -C "$faulty" fetch --quiet origin HEAD &&
    git -C "$faulty" checkout --quiet --force --detach FETCH_HEAD &&
    git -C "$faulty" clean --quiet -fd
}

# verdict_of I: in words.
verdict_of() {
  case ${verdicts[$1]} in
    found) printf 'found by %s in %d s' "${finders[$1]}" "${took[$1]}" ;;
    unsure) printf 'NOT FOUND, for %s fails without it too' "${finders[$1]}" ;;
    broken) printf 'DOES NOT COMPILE' ;;
    missed) printf 'NOT FOUND in %d s' "${took[$1]}" ;;
  esac
}

# try_fault I LOG: into verdicts, finders and took.
try_fault() {
  local i=$1 log=$2 began=$SECONDS finder=''
  case ${files[i]} in app/web/*) prepare_page >"$log" 2>&1 || fail "the page's own tests fail: $log" ;; esac
  put_in "$i"
  git -C "$faulty" diff >"$log"
  case ${files[i]} in
    app/web/*) ask_page ;;
    *) ask_tests "${files[i]%%/*}" ;;
  esac
  take_out
  took[i]=$((SECONDS - began)) finders[i]=$finder
}

# ask_tests ROOM: those of the room first, then all others, each once it is built.
ask_tests() {
  local programs
  mapfile -t programs < <(in_clone entries -L "^room-$1\$" | sed 's/[.].*//' | sort -u)
  is_built "${programs[@]}" || return 0
  is_found_by -L "^room-$1\$" -LE '^soak$' && return
  is_built || return 0
  is_found_by -LE "^(room-$1|soak)\$" && return
  verdicts[i]=missed
}

# is_built [TARGET...]: with the fault; else it is no fault to look for.
is_built() {
  verdicts[i]=found
  in_clone configure_and_make release "$@" >>"$log" 2>&1 </dev/null || { verdicts[i]=broken && return 1; }
}

# is_found_by ARGS: whether one of these tests fails, and fails again by itself; into `finder`. One that then passes
# finds nothing, and the others are asked without it.
is_found_by() {
  local entry unsteady='' without=()
  until ask_ctest --stop-on-failure "${without[@]}" "$@"; do
    read -r entry < <(failed_entries "$last_log") || fail "ctest names no test that failed: $log"
    if ! ask_ctest -R "^$entry\$"; then
      finder="$entry $(failed_case "$last_log")" finder=${finder% }
      return 0
    fi
    unsteady+=${unsteady:+|}$entry
    without=(-E "^($unsteady)\$")
  done
  return 1
}

# ask_ctest ARGS: what it says stands at the end of the fault's log, and alone in the last one.
ask_ctest() {
  local status=0
  in_clone run_ctest release "$@" >"$last_log" 2>&1 </dev/null || status=$?
  cat "$last_log" >>"$log"
  return "$status"
}

# failed_entries LOG: what CTest lists at its end, "  12 - test_core (Failed)".
failed_entries() {
  sed -nE 's/^[[:space:]]*[0-9]+ - ([^ ]+) \(.*/\1/p' "$1"
}

# failed_case LOG: the first that GoogleTest names.
failed_case() {
  sed -nE '/^\[  FAILED  \] [^ ,]+\.[^ ,]+/ { s/^\[  FAILED  \] ([^ ,]+).*/\1/p; q }' "$1"
}

# The page is as it should be: else its tests would find every fault.
prepare_page() {
  install_node && in_clone npm_ci && in_clone npm --prefix tests/web run unit
}

ask_page() {
  verdicts[i]=broken
  in_clone npm --prefix app/web run check >>"$log" 2>&1 </dev/null || return 0
  verdicts[i]=missed
  NO_COLOR=1 in_clone npm --prefix tests/web run unit >>"$log" 2>&1 </dev/null && return
  verdicts[i]=found
  finder="page units $(sed -nE '/^ *FAIL +/ { s/^ *FAIL +([^ ]+).*/\1/p; q }' "$log")"
}

# Tests that found something pass where nothing is wrong; those that do not have found nothing.
doubt_finders() {
  local i log=$fault_logs/without.log entries='' wrong
  for i in "${chosen[@]}"; do
    [[ ${verdicts[i]} == found && ${finders[i]} != 'page units '* ]] && entries+=${entries:+|}${finders[i]%% *}
  done
  [[ -n $entries ]] || return 0
  in_clone run_ctest release -R "^($entries)\$" >"$log" 2>&1 </dev/null && return
  wrong=" $(failed_entries "$log" | tr '\n' ' ')"
  for i in "${chosen[@]}"; do
    [[ ${verdicts[i]} == found && $wrong == *" ${finders[i]%% *} "* ]] && verdicts[i]=unsure
  done
  return 0
}
