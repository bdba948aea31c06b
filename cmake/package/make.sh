#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make.sh BUILD OUTPUT [gzip]: the Debian package of a build, in OUTPUT, packed by xz or more quickly. What no build
# makes goes into BUILD/package/doc: changelogs and the bill of materials. The only date in all of it is
# SOURCE_DATE_EPOCH, else that of the commit.
set -euo pipefail
build=$(realpath "$1") output=$(realpath -m "$2")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || stat -c %Y CHANGELOG.md)}
export SOURCE_DATE_EPOCH
doc=$build/package/doc
version=$(sed -n 's/^project(weft VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)

rm -rf "$doc" "$output"/weft_*.deb
mkdir -p "$doc" "$output"
gzip -9nc CHANGELOG.md >"$doc/changelog.gz"
gzip -9nc >"$doc/changelog.Debian.gz" <<END
weft ($version-1) unstable; urgency=medium

  * Packaged from its sources; changelog.gz says what is new.

 -- weft developers <weft@weft.example>  $(LC_ALL=C date -u -R -d "@$SOURCE_DATE_EPOCH")
END
node cmake/package/sbom.mjs "$version" . "$build"/bin/weft "$build"/bin/weft-{work,camera,bench} >"$doc/weft.cdx.json"
cd "$output" && cpack -D CPACK_DEBIAN_COMPRESSION_TYPE="${3:-xz}" --config "$build/CPackConfig.cmake" -B "$output"
rm -rf "$output/_CPack_Packages"
