#!/usr/bin/env python3
"""Makes the PTX of the kernels, `kernels/kernels.ptx`, with a pinned NVRTC, and checks its operations.

    crates/slipfront-gpu/ptx.py

Needs Python with venv and 90 MB from PyPI, but no GPU. The PTX is for GPUs of compute capability 7.0 and
later. Exits with 1 if an operation of doubles has another rounding than to nearest even, or is two in one.
"""

import ctypes
import glob
import re
import subprocess
import sys
import venv
from pathlib import Path

NVRTC = "nvidia-cuda-nvrtc-cu12==12.2.140"
OPTIONS = ["--gpu-architecture=compute_70", "--std=c++17", "--fmad=false"]
KERNELS = Path(__file__).resolve().parent / "kernels"


def library():
    """Return NVRTC, which is installed in a folder of its own under target."""
    folder = KERNELS.parents[2] / "target" / "nvrtc"
    if not (folder / NVRTC).exists():
        venv.create(folder, with_pip=True)
        subprocess.run([folder / "bin" / "pip", "install", "--quiet", NVRTC], check=True)
        (folder / NVRTC).touch()
    (found,) = glob.glob(str(folder / "lib/python*/site-packages/nvidia/cuda_nvrtc/lib/libnvrtc.so.12"))
    return ctypes.CDLL(found)


def compile_kernels():
    """Return the PTX."""
    nvrtc, program = library(), ctypes.c_void_p()
    headers = sorted(KERNELS.glob("*.h"))
    texts = [header.read_bytes() for header in headers]
    names = [header.name.encode() for header in headers]
    array = ctypes.c_char_p * len(headers)
    source = (KERNELS / "kernels.cu").read_bytes()
    nvrtc.nvrtcCreateProgram(
        ctypes.byref(program), source, b"kernels.cu", len(headers), array(*texts), array(*names)
    )
    options = [option.encode() for option in OPTIONS]
    status = nvrtc.nvrtcCompileProgram(program, len(options), (ctypes.c_char_p * len(options))(*options))
    size = ctypes.c_size_t()
    nvrtc.nvrtcGetProgramLogSize(program, ctypes.byref(size))
    log = ctypes.create_string_buffer(size.value)
    nvrtc.nvrtcGetProgramLog(program, log)
    if status != 0:
        sys.exit(log.value.decode())
    nvrtc.nvrtcGetPTXSize(program, ctypes.byref(size))
    ptx = ctypes.create_string_buffer(size.value)
    nvrtc.nvrtcGetPTX(program, ptx)
    return ptx.value.decode()


def check(ptx):
    """Check that every operation of doubles is rounded by itself, to nearest even."""
    operations = re.findall(r"^\s*(?:@!?%p\d+ )?((?:add|sub|mul|div|sqrt|rcp|fma|mad)\.\S*f64)\b", ptx, re.M)
    counts = {operation: operations.count(operation) for operation in sorted(set(operations))}
    print(", ".join(f"{count} {operation}" for operation, count in counts.items()))
    others = [operation for operation in counts if not re.fullmatch(r"(add|sub|mul|div|sqrt)\.rn\.f64", operation)]
    if others or "add.rn.f64" not in counts:
        sys.exit(f"operations that are not those of the CPU: {others}")


def main():
    """Make the PTX and check it."""
    ptx = compile_kernels()
    check(ptx)
    (KERNELS / "kernels.ptx").write_text(ptx)


main()
