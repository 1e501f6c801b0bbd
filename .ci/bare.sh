#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The README's first command on a Debian that has nothing, from the source archive alone: in a directory, which
# afterwards is gone. As root; a quarter of an hour. 77 and a line where that cannot be.
set -euo pipefail
cd "$(dirname "$0")/.."

skipped() { echo ".ci/bare.sh: skipped, $*"; exit 77; }
[[ $EUID -eq 0 ]] || skipped "not root"
command -v debootstrap >/dev/null || skipped "there is no debootstrap (tools/setup.sh machines)"
root=$(mktemp -d "${TMPDIR:-/var/tmp}/slf_bare.XXXXXX")
# Nothing is removed through a mount that is still there.
trap 'umount "$root/proc" "$root/dev" 2>/dev/null || true; rm -rf --one-file-system "$root" "$root.log"' EXIT

debootstrap --variant=minbase bookworm "$root" >"$root.log" 2>&1 || { tail -3 "$root.log"; skipped "no Debian to be had"; }
mount --bind /proc "$root/proc" && mount --bind /dev "$root/dev" || skipped "nothing can be mounted"
cp -L /etc/resolv.conf "$root/etc/"
mkdir -p "$root/srv/slf"
git archive HEAD | tar x -C "$root/srv/slf"
# Certificates that this machine's network asks for.
[[ -z ${NODE_EXTRA_CA_CERTS:-} ]] || cp -L "$NODE_EXTRA_CA_CERTS" "$root/srv/certificates"
chroot "$root" env -i HOME=/srv PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C NODE_EXTRA_CA_CERTS=/srv/certificates \
  /srv/slf/tools/demo.sh | tee "$root/srv/printed"
for made in demo.html demo.slf contact_sheet.png; do
  [[ -s $root/srv/slf/build/demo/$made ]] || { echo ".ci/bare.sh: the demo left no $made"; exit 1; }
done
grep -q "held-out image PSNR" "$root/srv/printed"
