#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check.sh BUILD: what is installed works where it is put, and strangers find nothing wrong with the package.
# What is missing on this machine is skipped aloud.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
stage=$work/stage
failures=0

# expect NAME COMMAND...: its output is shown where it fails.
expect() {
  local name=$1
  shift
  if "$@" >"$work/said" 2>&1; then
    printf '  %s\n' "$name" >&2
  else
    printf '  FAILED: %s\n' "$name" >&2
    tail -n 30 "$work/said" >&2
    failures=$((failures + 1))
  fi
}

# wants PROGRAM: whether it is there.
wants() {
  command -v "$1" >/dev/null || { printf '  skipped: %s is not installed\n' "$1" >&2 && return 1; }
}

install_staged() {
  DESTDIR=$stage cmake --install "$build" --prefix /usr
}

says_its_version() {
  local said
  said=$("$stage/usr/bin/weft" --version) && echo "$said" && [[ $said =~ ^[0-9]+\.[0-9]+\.[0-9]+(\ \(.*\))?$ ]]
}

# Without a network where this user may cut it; without a virtual rig, which is not installed.
runs_the_demo() {
  local cut=()
  unshare -rn true 2>/dev/null && cut=(unshare -rn)
  (cd "$work" && HOME=$work "${cut[@]}" "$stage/usr/bin/weft" demo --megapixels 0.01 --json -q >demo.json) &&
    node -e '
      const demo = JSON.parse(require("fs").readFileSync(process.argv[1]));
      console.log(demo);
      process.exit(demo.scanned === false && demo.normal.median_deg < 10 && require("fs").existsSync(demo.sheet) ? 0 : 1);
    ' "$work/demo.json"
}

# A verb of each of the installed programs, by the one that people call.
finds_its_programs() {
  "$stage/usr/bin/weft" solve --help && "$stage/usr/bin/weft" bench solve --help &&
    "$stage/usr/bin/weft" library --help && ! "$stage/usr/bin/weft" solve nothing.weft
}

pages_are_clean() {
  local page
  for page in "$stage"/usr/share/man/man1/*.gz; do
    gzip -dc "$page" >"$work/$(basename "$page" .gz)"
  done
  # Of style, mandoc wants pages that other pages name to be installed on this machine.
  ! (cd "$work" && mandoc -Tlint -Wstyle ./*.1 | grep -v 'referenced manual not found') &&
    (cd "$work" && mandoc -Tutf8 ./weft-solve.1 | sed 's/.\x08//g' | grep -e '--quality')
}

every_verb_has_a_page() {
  local verb
  for verb in $("$stage/usr/bin/weft" --help | sed -n '/^Scan:/,/^Exit codes:/s/^  \([a-z]*\) .*/\1/p'); do
    [[ -e $stage/usr/share/man/man1/weft-$verb.1.gz ]] || { echo "no page: $verb" && return 1; }
  done
  [[ -n ${verb:-} ]]
}

# completed WORD...: what bash offers for the last one.
completed() {
  bash --norc -c '
    source "$1"
    shift
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    compopt() { :; }
    _weft
    printf "%s " "${COMPREPLY[@]}"
  ' - "$stage/usr/share/bash-completion/completions/weft" "$@"
}

completes_words() {
  local said
  said="$(completed weft sol)/$(completed weft library ta)/$(completed weft solve --qual)"
  said+="/$(completed weft solve --quality ro)/$(completed weft solve --quality = ro)/$(completed weft solve some)"
  echo "$said"
  [[ $said == 'solve /tag /--quality /robust /robust / ' || $said == 'solve /tag /--quality /robust /robust /' ]]
}

unit_is_right() {
  local unit=$work/weft@.service
  sed "s#/usr/bin/weft#$stage/usr/bin/weft#" "$stage/usr/lib/systemd/system/weft@.service" >"$unit"
  grep -q '^ExecStart=/usr/bin/weft serve' "$stage/usr/lib/systemd/system/weft@.service" &&
    cp "$unit" "$work/weft@north.service" && systemd-analyze verify --recursive-errors=no "$work/weft@north.service"
}

# Rules of udev have a checker since systemd 254; here each line is at least one of known keys.
rules_are_right() {
  local rules
  for rules in "$stage"/usr/lib/udev/rules.d/*.rules; do
    ! grep -vE '^(#.*|)$|^([A-Z]+(\{[A-Z_a-z0-9]+\})?(==|!=|\+=|=|:=)"[^"]*"(, )?)+$' "$rules" || return 1
  done
}

bill_is_whole() {
  node -e '
    const bom = JSON.parse(require("fs").readFileSync(process.argv[1]));
    const refs = bom.components.map((each) => each["bom-ref"]);
    const names = bom.components.map((each) => each.name);
    const ok = bom.bomFormat === "CycloneDX" && bom.specVersion === "1.5" && new Set(refs).size === refs.length &&
      /^urn:uuid:[0-9a-f]{8}-[0-9a-f]{4}-5[0-9a-f]{3}-8[0-9a-f]{3}-[0-9a-f]{12}$/.test(bom.serialNumber) &&
      bom.components.every((each) => each.version && each.purl && each.type === "library") &&
      bom.dependencies[0].dependsOn.every((ref) => refs.includes(ref)) &&
      ["libc6", "libtiff6", "preact"].every((name) => names.includes(name));
    console.log(names.join(" "));
    process.exit(ok ? 0 : 1);
  ' "$build/package/doc/weft.cdx.json"
}

is_the_same_twice() {
  # Nobody's commit between the two is to be seen in them.
  local -x SOURCE_DATE_EPOCH
  SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null || stat -c %Y CHANGELOG.md)
  cmake/package/make.sh "$build" "$work/once" gzip && cmake/package/make.sh "$build" "$work/twice" gzip &&
    cmp "$work"/once/*.deb "$work"/twice/*.deb
}

package_is_small() {
  local bytes
  bytes=$(stat -c %s "$work"/once/*.deb) && echo "$bytes bytes" && ((bytes < 20000000))
}

lintian_is_content() {
  lintian --fail-on error,warning --tag-display-limit 0 "$work"/once/*.deb
}

expect 'installs into a staging folder' install_staged
expect 'the staged program says its version' says_its_version
expect 'the staged program finds those beside it' finds_its_programs
expect 'the demo runs from there without a network' runs_the_demo
expect 'every verb has a page' every_verb_has_a_page
wants mandoc && expect 'mandoc finds nothing in the pages' pages_are_clean
expect 'bash completes verbs, options and words' completes_words
wants zsh && expect 'zsh reads its completion' zsh -n "$stage/usr/share/zsh/vendor-completions/_weft"
wants fish && expect 'fish reads its completion' fish -n "$stage/usr/share/fish/vendor_completions.d/weft.fish"
wants systemd-analyze && expect 'systemd finds nothing in the unit' unit_is_right
expect 'rules of udev are rules' rules_are_right
wants desktop-file-validate &&
  expect 'the desktop entry is one' desktop-file-validate "$stage/usr/share/applications/weft.desktop"
wants appstreamcli &&
  expect 'the metainfo is one' appstreamcli validate --no-net "$stage"/usr/share/metainfo/*.xml
expect 'the package is the same when it is made twice' is_the_same_twice
expect 'the bill of materials is whole' bill_is_whole
expect 'the package is small' package_is_small
wants lintian && expect 'lintian finds nothing in the package' lintian_is_content
exit $((failures > 0))
