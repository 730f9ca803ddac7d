#!/bin/sh
# fetch_debian_libraries.sh ARCHITECTURE FOLDER PACKAGE...: unpacks packages of Debian for another processor, and the packages
# that they depend on, in FOLDER, without installing them. apt verifies them with Debian's keys. It uses lists of its own, so
# that the machine does not need the architecture. The release of Debian is the release of this machine.
set -eu
architecture=$1
folder=$2
shift 2

rm -rf "$folder"
mkdir -p "$folder/apt/lists/partial" "$folder/apt/cache/archives/partial"
cd "$folder/apt"
: >status
. /etc/os-release
keys=/usr/share/keyrings/debian-archive-keyring.gpg
cat >sources.list <<SOURCES
deb [signed-by=$keys] http://deb.debian.org/debian $VERSION_CODENAME main
deb [signed-by=$keys] http://deb.debian.org/debian-security $VERSION_CODENAME-security main
SOURCES

apt_get() {
  apt-get -qq -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" -o APT::Sandbox::User=root \
    -o Dir::Etc::SourceList="$PWD/sources.list" -o Dir::Etc::SourceParts=/dev/null -o Dir::State="$PWD" \
    -o Dir::State::Lists="$PWD/lists" -o Dir::State::Status="$PWD/status" -o Dir::Cache="$PWD/cache" "$@"
}
apt_get update
apt_get install -y --download-only --no-install-recommends "$@" >/dev/null
cd cache/archives
rm -f libc6* libc-dev* libcrypt* linux-libc-dev* # the compiler has its own C library
for package in *.deb; do
  dpkg-deb -x "$package" "$folder"
done
# The version of each library, for THIRD-PARTY-NOTICES.
for package in *.deb; do
  dpkg-deb -W --showformat='${Package} ${Version}\n' "$package"
done >"$folder/versions"
rm -rf "$folder/apt"
