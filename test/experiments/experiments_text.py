"""What the sections of docs/experiments.md have in common."""
import os
import shutil

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

STRATEGIES = {"surf": "SURF", "surf_ransac": "SURF+RANSAC", "surf_flann": "SURF+FLANN", "surf_flann_ransac": "SURF+FLANN+RANSAC"}
RATIO = 0.8  # of the comparison of methods
OTHERS_PICTURES = "_experiments"


def judge(is_so):
    return "reproduced" if is_so else "not reproduced"


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def save(figure, docs, name):
    figure.tight_layout()
    figure.savefig(os.path.join(docs, "experiments", name), dpi=75)
    plt.close(figure)
    return f"experiments/{name}"


def show(work, docs, file, name, caption):
    """The lines that show a picture of WORK_DIR, which is copied beside the page; not there: none. Recordings are not ours to
    publish: their pictures, but for plots (.png), stay out of the repository, in a folder that git ignores."""
    source = os.path.join(work, file)
    if not os.path.exists(source):
        return []
    is_ours = "rendered" in name or name.endswith(".png")
    folder = os.path.join(docs, "experiments") if is_ours else OTHERS_PICTURES
    os.makedirs(folder, exist_ok=True)
    shutil.copy(source, os.path.join(folder, name))
    if is_ours:
        return [f"{caption}:\n\n![{caption}](experiments/{name})\n"]
    return [f"{caption}: `{OTHERS_PICTURES}/{name}`\n"]
