#!/usr/bin/env bash
# Installs what porolub needs on Debian 12: system packages, .venv, the package itself.
# Does nothing, quickly, when that has been done for the present state of the build files.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
stamp=.venv/.install-stamp

packages=(
    python3-petsc4py-real python3-mpi4py python3-h5py python3-h5py-mpi python3-meshio
    python3-scipy openmpi-bin openssh-client
    python3-venv python3-dev gcc libc6-dev ca-certificates
    libgl1 libglu1-mesa libxrender1 libxcursor1 libxft2 libxinerama1 # for the gmsh wheel
)

say() { printf 'porolub: %s\n' "$*"; }
stop() { say "$*" >&2; exit 1; }

key=$(
    sha256sum pyproject.toml setup.py porolub/*/*.c .ci/install.sh
    echo "$root"
)
kernels=(porolub/fem/_kernels*.so porolub/laws/_tensors*.so)
if [[ -f $stamp && -e ${kernels[0]} && -e ${kernels[1]} && $(<"$stamp") == "$key" ]]; then
    exit 0
fi

system=$(. /etc/os-release 2>/dev/null && echo "${ID:-unknown} ${VERSION_ID:-}") || system=unknown
[[ $system == "debian 12" ]] || stop "cannot install: this is '$system', and the packages" \
    "porolub is built on (PETSc 3.18 and its Python bindings) are those of Debian 12."

missing=()
for package in "${packages[@]}"; do
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) || state=absent
    [[ $state == installed ]] || missing+=("$package")
done
if ((${#missing[@]})); then
    as_root=()
    if ((EUID != 0)); then
        command -v sudo >/dev/null || stop "cannot install: neither root nor sudo;" \
            "have an administrator run: apt-get install ${missing[*]}"
        as_root=(sudo)
        if [[ ! -t 0 ]] && ! sudo -n true 2>/dev/null; then
            stop "cannot install: sudo asks for a password and there is no terminal;" \
                "run this first: sudo apt-get install ${missing[*]}"
        fi
    fi
    apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq "$@"; }
    say "installing Debian packages (about 2 minutes): ${missing[*]}"
    apt update || say "the package lists could not be brought up to date, trying with the old ones"
    apt install -y --no-install-recommends "${missing[@]}" >/dev/null ||
        stop "cannot install the Debian packages (see above; no network?): ${missing[*]}"
fi

python=.venv/bin/python
if [[ ! -x $python ]] || ! grep -qs "$root/.venv\$" .venv/pyvenv.cfg; then
    say "creating .venv"
    /usr/bin/python3 -m venv --clear --system-site-packages .venv ||
        stop "cannot create the virtual environment $root/.venv (see above)."
fi
# petsc4py's own path file points nowhere on Debian 12
petsc=(/usr/lib/petscdir/petsc3.18/*-real/lib/python3/dist-packages)
[[ -d ${petsc[0]} ]] || stop "cannot find petsc4py below /usr/lib/petscdir/petsc3.18."
site=$("$python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
echo "${petsc[0]}" >"$site/petsc.pth"

say "installing porolub and its Python packages into .venv"
"$python" -m pip install --quiet --disable-pip-version-check --editable '.[dev]' ||
    stop "cannot install the Python packages (see above; no network or no C compiler?)."
"$python" -c 'import gmsh, h5py, meshio, mpi4py, petsc4py, scipy' ||
    stop "the installation is not complete: a package cannot be imported (see above)."
echo "$key" >"$stamp"
say "installed in $root/.venv"
