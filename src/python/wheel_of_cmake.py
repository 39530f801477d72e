"""`pip install .`: builds the package with CMake into a wheel. (PEP 517, PEP 427; needs neither network nor setuptools)"""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TAG = "cp{0}{1}-cp{0}{1}-{2}".format(*sys.version_info[:2], re.sub("[-.]", "_", sysconfig.get_platform()))


def _project():
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    return dict(re.findall(r'^(name|version|description|requires-python) = "(.*)"$', text, re.M))


def _metadata():
    p = _project()
    return (f"Metadata-Version: 2.1\nName: {p['name']}\nVersion: {p['version']}\nSummary: {p['description']}\n"
            f"Requires-Python: {p['requires-python']}\nRequires-Dist: numpy\n")


def _built():
    """The files of the package, by their names in it."""
    folder = ROOT / "build" / f"wheel-{TAG}"
    subprocess.check_call(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DEDMILL_TESTS=OFF",
                           "-DEDMILL_BENCHMARKS=OFF", "-DEDMILL_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"])
    subprocess.check_call(["cmake", "--build", folder, "--target", "edmill_python"])
    package = folder / "python" / "edmill"
    return {f"edmill/{f.name}": f.read_bytes() for f in sorted(package.iterdir()) if f.is_file()}


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    p = _project()
    info = f"{p['name']}-{p['version']}.dist-info"
    files = _built()
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: edmill\nRoot-Is-Purelib: false\nTag: {TAG}\n".encode()
    records = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        records.append(f"{name},sha256={digest},{len(content)}\n")
    files[f"{info}/RECORD"] = "".join([*records, f"{info}/RECORD,,\n"]).encode()
    wheel = f"{p['name']}-{p['version']}-{TAG}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    p = _project()
    name = f"{p['name']}-{p['version']}"
    subprocess.check_call(["git", "-C", ROOT, "archive", f"--prefix={name}/", "-o",
                           os.path.abspath(os.path.join(sdist_directory, f"{name}.tar.gz")), "HEAD"])
    return f"{name}.tar.gz"
