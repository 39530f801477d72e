"""UPDATES.jsonl: one line for each update of the fixtures, with the hashes of all of them, of the
line before, and of itself. The hashes find what was changed by mistake or in haste; whoever wants
to deceive is stopped by review, not by them."""
import datetime
import hashlib
import json
import os

LOG = "regression/ward/UPDATES.jsonl"
FIXTURES = ("regression/ward/fixtures", "regression/reference")  # folders
CASES = "regression/ward/cases"
# The certified sequences in regression/reference have their own evidence and test.
STATISTICS = ("regression/reference/ward.statistics.csv", "regression/reference/ward.replicas.csv")


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def own_hash(entry):
    return sha256(
        json.dumps({key: value for key, value in entry.items() if key != "entry"}).encode())


def present(root):
    """Hashes of the fixtures and of the cases that are there."""
    files = [place for folder in (FIXTURES[0], CASES) for place in (root / folder).glob("*")]
    files += [root / name for name in STATISTICS if (root / name).exists()]
    return {
        place.relative_to(root).as_posix(): sha256(place.read_bytes()) for place in sorted(files)
    }


def problems(root):
    """What is not as the log's last line says."""
    if not (root / LOG).exists():
        return [f"{LOG}: not there"]
    found, previous, entry = [], "", {"files": {}}
    for number, line in enumerate((root / LOG).read_text().splitlines(), 1):
        entry = json.loads(line)
        if entry["previous"] != previous or entry["entry"] != own_hash(entry):
            found.append(
                f"{LOG}:{number}: it or a line before it was changed; lines are only ever added")
        previous = sha256(line.encode())
    wanted, there = entry["files"], present(root)
    for name in sorted(wanted.keys() | there.keys()):
        if name not in there:
            found.append(f"{name}: not there")
        elif name not in wanted:
            found.append(f"{name}: not in the log")
        elif wanted[name] != there[name]:
            found.append(f"{name}: changed without edmill-fixtures update")
    return found


def write(root, texts, reason, sources):
    """Puts the files in place, each whole, then a line of the log."""
    for name, text in texts.items():
        place = root / name
        place.parent.mkdir(parents=True, exist_ok=True)
        temporary = place.with_name(place.name + ".tmp")
        temporary.write_text(text)
        os.replace(temporary, place)
    lines = (root / LOG).read_text().splitlines() if (root / LOG).exists() else []
    entry = {
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d"), "reason": reason,
        **sources, "changed": sorted(texts),
        "previous": sha256(lines[-1].encode()) if lines else "", "files": present(root)
    }
    entry["entry"] = own_hash(entry)
    with open(root / LOG, "a", encoding="utf-8") as file:
        file.write(json.dumps(entry) + "\n")
