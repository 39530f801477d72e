"""`pip install .`: builds the package with CMake into a wheel. (PEP 517, PEP 427; needs neither
network nor setuptools)

With `--config-settings=libraries=bundled` the wheel holds the shared libraries that it needs, by
patchelf, and can be installed where neither a compiler nor they are: on Linux with the C library of
this machine or a newer one (PEP 600).
"""
import base64
import hashlib
import os
import pathlib
import platform
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
PLATFORM = re.sub("[-.]", "_", sysconfig.get_platform())
# What every Linux with Python has: PEP 600 and its predecessors leave them out of wheels.
OF_THE_SYSTEM = re.compile(
    r"(ld-linux|libc|libm|libdl|librt|libpthread|libresolv|libgcc_s|libstdc\+\+|linux-vdso)[.-].*")


def _tag(bundled):
    system = PLATFORM.replace("linux", "manylinux_" +
                              platform.libc_ver()[1].replace(".", "_"), 1) if bundled else PLATFORM
    return "cp{0}{1}-cp{0}{1}-{2}".format(*sys.version_info[:2], system)


def _project():
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    return dict(re.findall(r'^(name|version|description|requires-python) = "(.*)"$', text, re.M))


def _metadata():
    p, text = _project(), (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    addresses = re.findall(r'^(\w+) = "(https:.*)"$', text, re.M)
    keywords = re.search(r"^keywords = \[(.*)\]$", text, re.M).group(1).replace('"', "")
    return "".join(f"{name}: {value}\n" for name, value in [
        ("Metadata-Version",
         "2.1"), ("Name", p["name"]), ("Version", p["version"]), ("Summary", p["description"]),
        ("License", "MIT"), ("Author", "The edmill authors"), ("Keywords", keywords),
        ("Requires-Python", p["requires-python"]), ("Requires-Dist", "numpy"), *(
            ("Classifier", line) for line in re.findall(r'^  "(.* :: .*)",$', text, re.M)), *(
                ("Project-URL", f"{name}, {address}")
                for name, address in addresses), ("Description-Content-Type", "text/markdown"),
    ]) + "\n" + (ROOT / "README.md").read_text(encoding="utf-8")


def _with_libraries(module):
    """The extension module, and the shared libraries that it needs, which find each other in
    edmill.libs."""
    lines = subprocess.run(["ldd", module], check=True, capture_output=True, text=True).stdout
    needed = {
        name: pathlib.Path(place) for name, place in re.findall(r"(\S+) => (/\S+)", lines)
        if not OF_THE_SYSTEM.match(name)
    }
    files = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, source, place in [
            (f"edmill/{module.name}", module, "$ORIGIN/../edmill.libs"),
                *((f"edmill.libs/{name}", source, "$ORIGIN") for name, source in needed.items())
        ]:
            copy = pathlib.Path(folder) / pathlib.Path(name).name
            copy.write_bytes(source.read_bytes())
            # DT_RPATH, which libraries of libraries are looked for in, too.
            subprocess.check_call(["patchelf", "--force-rpath", "--set-rpath", place, copy])
            files[name] = copy.read_bytes()
    return files


def _built(bundled):
    """The files of the package, by their names in it."""
    folder = ROOT / "build" / f"wheel-{_tag(bundled)}"
    # Sweeps over several machines need the MPI of these machines.
    subprocess.check_call([
        "cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
        "-DEDMILL_TESTS=OFF", "-DEDMILL_BENCHMARKS=OFF", "-DEDMILL_PYTHON=ON",
        f"-DPython_EXECUTABLE={sys.executable}",
        f"-DCMAKE_CXX_FLAGS=-ffile-prefix-map={ROOT}/=",  # the bytes do not depend on where the tree is
        f"-DCMAKE_DISABLE_FIND_PACKAGE_MPI={'ON' if bundled else 'OFF'}"
    ])
    subprocess.check_call(["cmake", "--build", folder, "--target", "edmill_python"])
    package = folder / "python" / "edmill"
    files = {f"edmill/{f.name}": f.read_bytes() for f in sorted(package.iterdir()) if f.is_file()}
    if bundled:
        for module in package.glob("_edmill*.so"):
            files.update(_with_libraries(module))
    return files


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    p = _project()
    wanted = (config_settings or {}).get("libraries", "of the system")
    if wanted not in ("bundled", "of the system"):
        raise SystemExit(
            f"config setting 'libraries': found '{wanted}', expected 'bundled' or nothing")
    tag = _tag(wanted == "bundled")
    info = f"{p['name']}-{p['version']}.dist-info"
    files = _built(wanted == "bundled")
    files[f"{info}/METADATA"] = _metadata().encode()
    files[
        f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: edmill\nRoot-Is-Purelib: false\nTag: {tag}\n".encode(
        )
    records = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        records.append(f"{name},sha256={digest},{len(content)}\n")
    files[f"{info}/RECORD"] = "".join([*records, f"{info}/RECORD,,\n"]).encode()
    wheel = f"{p['name']}-{p['version']}-{tag}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w",
                         zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name,
                                    date_time=(1980, 1, 1, 0, 0, 0))  # the same bytes each time
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    p = _project()
    name = f"{p['name']}-{p['version']}"
    subprocess.check_call([
        "git", "-C", ROOT, "archive", f"--prefix={name}/", "-o",
        os.path.abspath(os.path.join(sdist_directory, f"{name}.tar.gz")), "HEAD"
    ])
    return f"{name}.tar.gz"
