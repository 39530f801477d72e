import os
import pathlib
import subprocess

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[3]


@pytest.fixture
def program():
    """Runs the program."""

    def call(*arguments):
        return subprocess.run([os.environ["EDMILL"], *map(str, arguments)], check=True,
                              capture_output=True, text=True)

    return call


@pytest.fixture
def demo():
    return SOURCE / "docs/examples/demo.toml"
