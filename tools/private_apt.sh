# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Sourced by those that fetch packages of another release or machine.

# apt with lists of its own: what the machine has installed plays no part. Use it with APT_CONFIG=$1/apt.conf.
# $1: scratch folder  $2: release of Debian, options of its source in brackets before it  $3: architecture
write_apt_configuration() {
  local state=$1 options='' release=$2 arch=$3 mirror
  case $release in
    \[*) options="${release%% *} " release=${release#* } ;;
  esac
  mirror=$(sed -n 's#^\(URIs: *\|deb \(\[[^]]*\] \)\?\)\(https\?://[^ ]*/debian\)/\? *.*#\3#p' \
    /etc/apt/sources.list /etc/apt/sources.list.d/*.sources 2>/dev/null | head -n 1) || true
  mkdir -p "$state/lists/partial" "$state/cache/archives/partial"
  : >"$state/status"
  echo "deb $options${mirror:-http://deb.debian.org/debian} $release main" >"$state/sources.list"
  cat >"$state/apt.conf" <<TEXT
Dir::Etc::SourceList "$state/sources.list";
Dir::Etc::SourceParts "/dev/null";
Dir::Etc::Preferences "/dev/null";
Dir::Etc::PreferencesParts "/dev/null";
Dir::State "$state";
Dir::State::Lists "$state/lists";
Dir::State::Status "$state/status";
Dir::Cache "$state/cache";
APT::Architecture "$arch";
APT::Architectures "$arch";
APT::Sandbox::User "";
APT::Install-Recommends "false";
Acquire::Languages "none";
Acquire::IndexTargets::deb::DEP-11::DefaultEnabled "false";
TEXT
}
