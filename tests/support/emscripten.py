"""The page of the mill and the npm package, made by release/npm.sh, and the digests that their runs
must have."""
import csv
import subprocess

from program import SOURCE


def build(folder):
    """@return the page and the npm package"""
    subprocess.run([SOURCE / "release/npm.sh", folder], check=True, stdout=subprocess.DEVNULL)
    tarball, = folder.glob("edmill-*.tgz")
    return folder / "edmill.html", tarball


def published(name):
    """The digest of a log that every machine makes."""
    for row in csv.reader((SOURCE / "regression/reference/bits.tsv").read_text().splitlines(),
                          delimiter="\t", quoting=csv.QUOTE_NONE):
        if row[0] == name and row[2] == "double":
            return row[4]
    raise KeyError(name)
