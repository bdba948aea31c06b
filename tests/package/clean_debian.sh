#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# clean_debian.sh PACKAGE: installs the package in a fresh Debian 12, made by mmdebstrap from the mirrors of this
# machine, and does there what a person does first. As root; a gigabyte of disk, some minutes.
set -euo pipefail
package=$(realpath "$1")
((EUID == 0)) || { printf 'skipped: %s wants root\n' "$0" >&2 && exit 0; }
command -v mmdebstrap >/dev/null || { printf 'skipped: mmdebstrap is not installed\n' >&2 && exit 0; }
root=$(mktemp -d)
trap 'umount -q "$root/proc" || true; rm -rf --one-file-system "$root"' EXIT

say() {
  printf '  %s\n' "$*" >&2
}
inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
}
# Files and folders of weft, but for what dpkg keeps of any package that it saw.
traces() {
  inside find / -xdev -path /proc -prune -o -name '*weft*' -print | grep -v '^/var/\(lib/dpkg\|cache\|log\)/' | sort
}

sources=(/etc/apt/sources.list.d/*.sources /etc/apt/sources.list)
for list in "${sources[@]}"; do
  [[ -s $list ]] && mirrors+=("$list")
done
mmdebstrap --quiet --mode=root --variant=minbase --include=man-db,bash-completion bookworm "$root" "${mirrors[@]}"
mount -t proc proc "$root/proc"
say "a fresh Debian $(cat "$root/etc/debian_version")"

cp "$package" "$root/tmp/weft.deb"
before=$(inside dpkg-query -W -f '${Installed-Size}\n' | awk '{ sum += $1 } END { print sum }')
inside apt-get -qq update
inside apt-get -qq install -y --no-install-recommends /tmp/weft.deb >/dev/null
after=$(inside dpkg-query -W -f '${Installed-Size}\n' | awk '{ sum += $1 } END { print sum }')
rm "$root/tmp/weft.deb"
say "installed, with $(((after - before) / 1024)) MiB of what it needs"

say "version $(inside weft --version)"
unshare -n chroot "$root" env -i PATH=/usr/bin:/bin HOME=/var/tmp sh -c 'cd /var/tmp && weft demo --megapixels 0.01 -q' >&2
[[ -s $(echo "$root"/var/tmp/demo/demo.weft/solve/*/normal.exr) ]]
say 'the demo ran without a network'
inside man -P cat weft-solve | grep -q 'SYNOPSIS'
say 'man weft-solve has a page'
offered=$(inside bash -c '. /usr/share/bash-completion/bash_completion; _completion_loader weft
  COMP_WORDS=(weft sol) COMP_CWORD=1; _weft; echo "${COMPREPLY[*]}"')
[[ $offered == solve ]]
say 'bash completes weft sol'

mkdir -p "$root/etc/weft" "$root/var/lib/weft/north"
touch "$root/etc/weft/north.toml" "$root/var/lib/weft/north/cloth.weft"
inside apt-get -qq purge -y weft >/dev/null
left=$(traces)
[[ $left == $'/etc/weft\n/var/lib/weft\n/var/lib/weft/north/cloth.weft\n/var/tmp/demo/demo.weft' ]] ||
  { printf 'purge left\n%s\n' "$left" >&2 && exit 1; }
say 'purged; only data is left'
