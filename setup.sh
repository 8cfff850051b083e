#!/usr/bin/env bash
# Creates .venv with the locked versions of everything that boatsim and its tests need. A second run only checks it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

say() { echo "setup.sh: $1"; }
fits() { "$1" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] < (3, 15))' 2>/dev/null; }

make_venv() {
    say "creating .venv"
    for python in python3 python3.12 python3.11 python3.13 python3.14; do
        if fits "$python"; then
            "$python" -m venv --clear .venv
            return
        fi
    done
    if command -v uv >/dev/null; then
        uv venv --seed --clear --python 3.12 .venv
        return
    fi
    echo "setup.sh: boatsim needs Python 3.11, 3.12, 3.13 or 3.14. None of them was found, and uv is not installed either." >&2
    exit 2
}

[ -x .venv/bin/pip ] && fits .venv/bin/python || make_venv
say "$(.venv/bin/python --version); installing what requirements.lock states: some minutes the first time, seconds later"
# Python compiles a module at its first import, and most of them are never imported. Where it must not write what it compiled, it
# would compile them again at each start.
compile=--no-compile
if [ -n "${PYTHONDONTWRITEBYTECODE:-}" ]; then
    compile=--compile
fi
.venv/bin/python -m pip install --quiet "$compile" --progress-bar on --disable-pip-version-check --requirement requirements.lock
.venv/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --editable .
say "ready: .venv/bin/boatsim"
