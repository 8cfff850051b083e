"""What boatsim uses of undocumented parts of numba, llvmlite and MuJoCo.

Only `function_compiler`, which replaces passes of numba's compiler, relies on others. Each
assumption below is checked by `tests/test_compiler_internals.py`, and the upper bounds on numba and
MuJoCo in `pyproject.toml` exist because of these two modules: raise a bound after that test and
`tests/physics/test_function_compiler.py` have passed on the new version.

1. numba reads the default of each argument of a Python function through an `AbstractTemplate`
   (`register_with_numba`).
2. numba keeps compiled code in a `FunctionCache`, whose file object may be given another class and
   whose folder a `_CacheLocator` chooses (`keep_on_disk`).
3. The option `_nrt=False` switches off numba's reference counts (`WITHOUT_REFERENCE_COUNTS`).
4. A compiled function has a C wrapper whose address may be passed to other compiled code
   (`FunctionPointer`).
5. `CFunc` accepts such a cache too (`compile_callback`), and an intrinsic may return a pointer
   (`pointer_from_integer`).
6. The C structs of MuJoCo hold the addresses of their arrays, so that a search in memory finds the
   offset of each field in whatever version is installed (`mujoco_layout`).
"""

import ctypes
import pickle
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils, utils
from numba.core.base import BaseContext
from numba.core.caching import (
    CompileResultCacheImpl,
    FunctionCache,
    IndexDataCacheFile,
    _CacheLocator,
)
from numba.core.ccallback import CFunc
from numba.core.typing.templates import AbstractTemplate, Signature, infer_global, signature
from numba.extending import intrinsic, lower_builtin

from boatsim.errors import BadInput, BadPhysics
from boatsim.physics.cache_folder import cache_folder
from boatsim.physics.dependency_hash import dependency_digest

# numba counts references to arrays with locked instructions at every assignment, which takes longer
# than the laws of a vessel themselves. Functions that allocate no arrays do without.
WITHOUT_REFERENCE_COUNTS: Mapping[str, Any] = {"_nrt": False}

# Named tuples with default values
# ------------------------------------------------------------------------------------------------


def register_with_numba(constructor: Callable[..., object], record: type) -> None:
    """Make a Python function that builds a named tuple with defaults callable from numba code.

    numba does not support defaults of named tuples, and a small compiled function in place of the
    constructor would have its types inferred again at every call. The constructor is therefore
    registered by its signature alone.

    Args:
        constructor: Python function whose arguments are the fields of `record`, floats with a
            default.
        record: The named tuple that it returns.
    """
    python = utils.pysignature(constructor)
    defaults = {name: float(about.default) for name, about in python.parameters.items()}

    class Constructor(AbstractTemplate):
        """Typing of one call: an argument that is not given has its default."""

        def generic(self, args: Sequence[types.Type], kws: Mapping[str, types.Type]) -> Signature:
            given = python.bind(*args, **kws).arguments
            full = [given.get(name, types.Omitted(value)) for name, value in defaults.items()]
            result = types.BaseTuple.from_types([types.float64] * len(full), record)
            return signature(result, *full).replace(pysig=python)

    infer_global(constructor)(Constructor)

    @lower_builtin(constructor, types.VarArg(types.Any))
    def build_named_tuple(
        context: BaseContext, builder: ir.IRBuilder, call: Signature, args: Sequence[ir.Value]
    ) -> ir.Value:
        items = []
        for value, kind in zip(args, call.args, strict=True):
            if isinstance(kind, types.Omitted):
                items.append(context.get_constant(types.float64, float(kind.value)))
            else:
                items.append(context.cast(builder, value, kind, types.float64))
        return context.make_tuple(builder, call.return_type, items)


# Compiled code on disk
# ------------------------------------------------------------------------------------------------

DIGEST_SIZE = sha256().digest_size  # bytes in front of each file of compiled code


PROGRAM = "program_"  # begins the name of a folder of a vessel's program


class SealedCacheFile(IndexDataCacheFile):
    """Cache files of numba's compiled code of one function, each with a digest of its content.

    A damaged file counts as missing. numba compares the content of the function's own file alone;
    here the content of all modules of boatsim that the file imports counts as well.
    """

    source: Path

    @property
    def _source_stamp(self) -> str:
        if self.source.parent.name.startswith(PROGRAM):
            return ""  # the folder of a compiled program is named by its content
        return dependency_digest(self.source)

    def load(self, key: Any) -> Any:
        """Return the compiled code that is stored for a signature of the function, or None.

        None means that there is no file, or that it cannot be read or is damaged.
        """
        with suppress(Exception):  # a damaged pickle may raise any exception
            return super().load(key)
        return None

    def save(self, key: Any, data: Any) -> None:
        """Store compiled code in the cache; if that fails, the next process compiles it again."""
        try:
            super().save(key, data)
        except Exception:  # the index cannot be read: start another one
            with suppress(Exception):
                self.flush()
                super().save(key, data)

    def _save_data(self, name: str, data: Any) -> None:
        content = self._dump(data)
        with self._open_for_write(self._data_path(name)) as file:
            file.write(sha256(content).digest() + content)

    def _load_data(self, name: str) -> Any:
        whole = Path(self._data_path(name)).read_bytes()
        if sha256(whole[DIGEST_SIZE:]).digest() != whole[:DIGEST_SIZE]:
            raise OSError(f"{name} is damaged")
        return pickle.loads(whole[DIGEST_SIZE:])


class _InCacheFolder(_CacheLocator):
    """Chooses boatsim's cache folder for the code of a function; numba's own may be of anybody.

    numba stores its index as a pickle, which can run any code, beside the function's file or in a
    folder that other users may write to.
    """

    def __init__(self, line: int, file: Path) -> None:
        self.line, self.file = line, file

    @classmethod
    def from_function(cls, py_func: Callable[..., Any], py_file: str) -> "_InCacheFolder":
        return cls(py_func.__code__.co_firstlineno, Path(py_file))

    def get_cache_path(self) -> str:
        folder = self.file.parent
        if not folder.name.startswith(PROGRAM):  # programs lie in the cache folder already
            folder = cache_folder() / "functions" / self.get_suitable_cache_subpath(str(self.file))
        return str(folder / "__pycache__")

    def get_source_stamp(self) -> str:
        return ""  # `SealedCacheFile` has its own

    def get_disambiguator(self) -> str:
        return str(self.line)


class _InCacheFolderImpl(CompileResultCacheImpl):
    _locator_classes = (_InCacheFolder,)


class _CacheInFolder(FunctionCache):
    _impl_class = _InCacheFolderImpl


def keep_on_disk(compiled: Any, function: Callable[..., Any]) -> Any:
    """Make a function compiled by numba store its machine code on disk; return it.

    Without a safe folder it is compiled again by every process.

    Args:
        compiled: Dispatcher or C callback that numba made of `function`.
        function: The Python function.
    """
    with suppress(BadInput):
        compiled._cache = _CacheInFolder(function)
    if not isinstance(compiled._cache, _CacheInFolder):
        return compiled
    compiled._cache._cache_file.__class__ = SealedCacheFile
    compiled._cache._cache_file.source = Path(function.__code__.co_filename)
    return compiled


# Pointers
# ------------------------------------------------------------------------------------------------


class NativePointer:
    """Wrapper by which a C function is passed as an argument to a compiled function."""

    def __init__(self, address: int, call: Any) -> None:
        """Keep the address of a C function of the signature `call`."""
        self._address = address
        self._numba_type_ = types.FunctionType(call)

    @property
    def kind(self) -> Any:
        """The numba type of the function pointer."""
        return self._numba_type_

    def __wrapper_address__(self) -> int:
        return self._address


class FunctionPointer(NativePointer):
    """Wrapper by which a function of numba is passed as an argument to a compiled function.

    The passed function has one fixed signature.
    """

    def __init__(self, function: Any, call: Any) -> None:
        """Compile `function` for the signature `call`, unless that was done before."""
        function.compile(call.args)
        compiled = function.get_compile_result(call)
        name = compiled.fndesc.llvm_cfunc_wrapper_name
        super().__init__(int(compiled.library.get_pointer_to_function(name)), call)
        self._function = function  # its code must exist as long as the address is used


@intrinsic
def pointer_from_integer(context: Any, word: Any) -> Any:
    """Return, in compiled code, the pointer to the memory address that an integer contains."""

    def generate_cast(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], cgutils.voidptr_t)

    return types.voidptr(word), generate_cast


def compile_callback(function: Callable[..., Any]) -> Any:
    """Compile a function of two pointers without a result to a C function, cached on disk."""
    options = {"nopython": True, "error_model": "numpy"}
    signature = ((types.voidptr, types.voidptr), types.void)
    native = keep_on_disk(CFunc(function, signature, {}, options), function)
    native.compile()
    return native


# MuJoCo's structs
# ------------------------------------------------------------------------------------------------

FIELDS = ("qpos", "qvel", "userdata", "qfrc_passive", "M")  # arrays of mjData
WORD = 8  # [bytes]
BLOCK = 32  # [words] that are searched at a time
SEARCH_LIMIT = 1 << 17  # [words] every field of interest lies within this distance of the start
PROBE_TIME = 76543.21098765432  # [s] occurs nowhere else in a fresh mjData
PROBE_SIZES = (1237, 3571, 911)  # sizes of userdata that occur nowhere else in a fresh mjModel
PROBE_MODELS = (
    """<mujoco><size nuserdata="5"/><worldbody><body>
    <joint type="slide" axis="1 0 0"/><joint axis="0 0 1"/>
    <inertial pos="0 0 .1" mass="1" diaginertia="1 1 1"/></body></worldbody></mujoco>""",
    """<mujoco><size nuserdata="3"/><worldbody><body>
    <freejoint/><geom size=".1"/></body></worldbody></mujoco>""",
)


@cache
def mujoco_layout() -> dict[str, int]:
    """Return the memory offsets of those fields of MuJoCo's structs that the callback needs.

    No header file is needed: Python knows the addresses of the arrays of mjData, and the struct is
    searched for them.

    Returns:
        Offsets of the fields of mjData and of its time in 8-byte words, and of `nuserdata` of
        mjModel in 4-byte words.

    Raises:
        BadPhysics: A field is not found.
    """
    import mujoco

    saved = mujoco.get_mjcb_passive()
    mujoco.set_mjcb_passive(None)  # compiling the probes would run a callback
    try:
        probes = [mujoco.MjData(mujoco.MjModel.from_xml_string(xml)) for xml in PROBE_MODELS]
        found = {}
        for name in FIELDS:
            # A field of size zero has the address of the next one: of the candidates that are
            # common to both probes the last one is right.
            first, second = probes
            hits = _search(first._address, getattr(first, name).ctypes.data)
            hits &= _search(second._address, getattr(second, name).ctypes.data)
            if not hits:
                raise BadPhysics(f"mjData.{name} not found in MuJoCo {mujoco.__version__}")
            found[name] = max(hits)
        probes[0].time = PROBE_TIME
        times = _search(probes[0]._address, int(np.float64(PROBE_TIME).view(np.int64)))
        if not times:
            raise BadPhysics(f"mjData.time not found in MuJoCo {mujoco.__version__}")
        found["time"] = min(times)
        found["nuserdata"] = _offset_of_nuserdata()
    finally:
        mujoco.set_mjcb_passive(saved)
    return found


def _search(address: int, wanted: int) -> set[int]:
    """Offsets of the words equal to `wanted`.

    Ends soon after the first one, to stay within the struct.
    """
    hits: set[int] = set()
    pattern = wanted.to_bytes(WORD, sys.byteorder, signed=True)
    for start in range(0, SEARCH_LIMIT, BLOCK):
        words = ctypes.string_at(address + WORD * start, WORD * BLOCK)
        found = words.find(pattern)
        before = len(hits)
        while found >= 0:
            if found % WORD == 0:
                hits.add(start + found // WORD)
            found = words.find(pattern, found + 1)
        if hits and len(hits) == before:
            break
    return hits


def _offset_of_nuserdata() -> int:
    """Offset of mjModel.nuserdata in 4-byte words, from models of several known sizes."""
    import mujoco

    common: set[int] = set(range(512))
    for size in PROBE_SIZES:
        model = mujoco.MjModel.from_xml_string(f'<mujoco><size nuserdata="{size}"/></mujoco>')
        start = ctypes.cast(model._address, ctypes.POINTER(ctypes.c_int32))
        words = np.ctypeslib.as_array(start, (512,))
        common &= set(np.flatnonzero(words == size).tolist())
    if len(common) != 1:
        raise BadPhysics(f"mjModel.nuserdata not found in MuJoCo {mujoco.__version__}")
    return common.pop()


@cache
def mujoco_library() -> ctypes.CDLL:
    """Load MuJoCo's shared library, so that compiled code can call its functions.

    Raises:
        BadPhysics: The package of MuJoCo holds no library.
    """
    import mujoco
    from llvmlite import binding

    folder = Path(mujoco.__file__).parent
    libraries = sorted([*folder.glob("libmujoco.so*"), *folder.glob("libmujoco*.dylib")])
    if not libraries:
        raise BadPhysics(f"no library of MuJoCo in {folder}")
    binding.load_library_permanently(str(libraries[0]))
    return ctypes.CDLL(str(libraries[0]))
