#!/usr/bin/env bash
# Sets up .venv with the locked versions of everything boatsim needs, its tests too. Run again, it only checks.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

fits() { "$1" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] < (3, 13))' 2>/dev/null; }

make_venv() {
    for python in python3 python3.12 python3.11; do
        if fits "$python"; then
            "$python" -m venv --clear .venv
            return
        fi
    done
    if command -v uv >/dev/null; then
        uv venv --seed --clear --python 3.12 .venv
        return
    fi
    echo "setup.sh: boatsim needs Python 3.11 or 3.12; found neither, nor uv, which could bring one" >&2
    exit 2
}

[ -x .venv/bin/pip ] && fits .venv/bin/python || make_venv
.venv/bin/python -m pip install --quiet --disable-pip-version-check --requirement requirements.lock
.venv/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --editable .
