"""Build of the compiled kernels; everything else is in pyproject.toml."""

import os
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.errors import CCompilerError, CompileError, ExecError

# -ffast-math is left out on purpose: it would flush denormals to zero for the whole process.
FLAGS = ["-O3", "-std=c11", "-fno-math-errno", "-fno-trapping-math"]
NATIVE = "-march=native"


class BuildKernels(build_ext):
    """Compiles for this machine's processor where the compiler can, and explains failures.

    POROLUB_CFLAGS replaces -march=native, for a build that other processors shall run.
    """

    def _accepts(self, flag: str) -> bool:
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder) / "probe.c"
            source.write_text("int probe(void) { return 0; }\n")
            try:
                self.compiler.compile([str(source)], output_dir=folder, extra_postargs=[flag])
            except (CompileError, ExecError):
                return False
        return True

    def build_extension(self, ext: Extension) -> None:
        machine = os.environ.get("POROLUB_CFLAGS")
        chosen = machine.split() if machine is not None else []
        if machine is None and self._accepts(NATIVE):
            chosen = [NATIVE]
        ext.extra_compile_args = FLAGS + chosen
        try:
            super().build_extension(ext)
        except (CCompilerError, ExecError) as error:
            raise SystemExit(
                "porolub: the compiled kernels could not be built; a C compiler and Python's "
                "headers are needed (on Debian: apt install gcc libc6-dev python3-dev). "
                f"The compiler said: {error}"
            ) from error


setup(
    ext_modules=[
        Extension("porolub.fem._kernels", ["porolub/fem/kernels.c"], libraries=["m"]),
        Extension("porolub.laws._tensors", ["porolub/laws/tensors.c"], libraries=["m"]),
    ],
    cmdclass={"build_ext": BuildKernels},
)
