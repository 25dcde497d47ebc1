# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# What the scripts of tools/ share; sourced, never run. Progress goes to stderr, details to build/*.log.

set -euo pipefail
unset CDPATH

repository="$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)"
build_dir="$repository/build/release"

say() { printf '%s\n' "$*" >&2; }

die() {
  say "$(basename -- "$0"): error: $*"
  exit 1
}

# os_release KEY: prints that value of this system's description; prints nothing if there is none.
os_release() { sed --quiet --regexp-extended "s/^$1=\"?([^\"]*)\"?$/\\1/p" /etc/os-release 2>/dev/null || true; }

# run_logged LOG COMMAND...: runs the command and writes its output to build/LOG. The output is also printed if the
# command fails.
run_logged() {
  local log="$repository/build/$1"
  shift
  mkdir -p -- "$repository/build"
  if ! "$@" >"$log" 2>&1; then
    tail -n 40 -- "$log" >&2
    die "'$*' failed; the whole output is in $log"
  fi
}

# Prints a line whenever another quarter of the steps is done, which ninja counts as [done/all].
show_quarters() {
  local line shown=0 quarter
  while IFS= read -r line; do
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
      quarter=$((4 * BASH_REMATCH[1] / BASH_REMATCH[2]))
      if ((quarter > shown)); then
        say "Building build/release: ${BASH_REMATCH[1]} of ${BASH_REMATCH[2]} steps"
        shown=$quarter
      fi
    fi
  done
}

# prepare TARGET...: installs missing packages and brings these targets of build/release up to date. If there is nothing
# to do, this takes no time.
prepare() {
  local log="$repository/build/build.log"
  "$repository/tools/setup"
  cd -- "$repository"
  # CMake's results depend on the installed packages, which may have changed since.
  if [[ ! $build_dir/build.ninja -nt $repository/CMakePresets.json ||
    ! $build_dir/build.ninja -nt /var/lib/dpkg/status ]]; then
    say "Configuring build/release"
    run_logged configure.log cmake --preset release
  fi
  if ! cmake --build --preset release --target "$@" 2>&1 | tee "$log" | show_quarters; then
    grep -A 20 -m 1 '^FAILED' "$log" >&2 || tail -n 20 "$log" >&2
    die "the build failed; the whole output is in $log"
  fi
  cd -- "$OLDPWD"
}

# list_drivers: prints a line for the system's driver and for each driver of tools/drivers: its name, a tab, and its ICD
# file, which the system's driver does not have. If tools/drivers fails, the function prints the first line and fails.
list_drivers() {
  printf 'system\t\n'
  "$repository/tools/drivers"
}

# on_driver ICD COMMAND...: runs the command with only the driver of this ICD file and the libraries beside it. Without
# an ICD file, the command uses the system's driver.
on_driver() (
  icd="$1"
  shift
  if [[ $icd ]]; then
    export VK_DRIVER_FILES="$icd" VK_ICD_FILENAMES="$icd"
    export LD_LIBRARY_PATH="${icd%/*}${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
  fi
  "$@"
)

# run_python SCRIPT ARGUMENT...: runs a script of tools/lab with PROMIN_PYTHON or the system's Python, for which
# matplotlib is packaged.
run_python() {
  local python=python3
  [[ ! -x /usr/bin/python3 ]] || python=/usr/bin/python3
  "${PROMIN_PYTHON:-$python}" "$repository/tools/lab/$1" "${@:2}"
}

# describe_commit: prints the commit of the sources, with -dirty if any file outside docs differs from it, because no
# program is made from docs.
describe_commit() {
  local commit
  commit="$(git -C "$repository" describe --always 2>/dev/null)" || commit=unknown
  git -C "$repository" diff --quiet HEAD -- ":/" ":(top,exclude)docs" 2>/dev/null || commit+="-dirty"
  printf '%s\n' "${commit/unknown-dirty/unknown}"
}
