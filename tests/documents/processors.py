# SPDX-License-Identifier: Apache-2.0
"""Other processors than this one, as far as libm, numpy and OpenBLAS choose their code by them."""

from __future__ import annotations

import subprocess
import sys

NAMES = ("own", "avx2", "sse4", "plain-numpy")
LIBM = "GLIBC_TUNABLES"
NUMPY = "NPY_DISABLE_CPU_FEATURES"
BLAS = "OPENBLAS_CORETYPE"


def environment(name: str) -> dict[str, str]:
    """The variables under which a program computes as on such a processor: one without AVX-512 (avx2),
    one without AVX and fused multiply-add as well (sse4), this one but for numpy (plain-numpy)."""
    if name == "own":
        return {}
    features = dispatched()
    wide = [f for f in features if f.startswith("AVX512")]
    if name == "plain-numpy":
        return {NUMPY: " ".join(features)}
    if name == "avx2":
        return {LIBM: "glibc.cpu.hwcaps=-AVX512F,-AVX512VL", NUMPY: " ".join(wide), BLAS: "Haswell"}
    if name == "sse4":
        return {LIBM: "glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX2,-AVX,-FMA,-FMA4",
                NUMPY: " ".join(features), BLAS: "Nehalem"}
    raise ValueError(f"no processor '{name}'; there are {', '.join(NAMES)}")


def dispatched() -> list[str]:
    """The features of this processor for which numpy has code of their own."""
    code = ("from numpy.core._multiarray_umath import __cpu_dispatch__ as d, __cpu_features__ as f\n"
            "print(*(name for name in d if f[name]))")
    return subprocess.run([sys.executable, "-c", code], check=True, capture_output=True,
                          text=True).stdout.split()
