"""Runs the notebooks of docs/guide/notebooks and stores their outputs: `make notebooks`."""

import os
import pathlib

SOURCE = pathlib.Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((SOURCE / "docs/guide/notebooks").glob("*.ipynb"))


def main():
    import nbclient
    import nbformat

    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # of a debugger that no notebook uses

    for path in NOTEBOOKS:
        notebook = nbformat.read(path, as_version=4)
        nbclient.NotebookClient(notebook, kernel_name="python3", record_timing=False,
                                resources={"metadata": {"path": SOURCE}}).execute()
        notebook.metadata = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
        for cell in notebook.cells:
            for output in cell.get("outputs", []):
                data = output.get("data", {})
                if "image/png" in data:  # small, and web pages show it
                    data.pop("text/html", None)
        nbformat.write(notebook, path)
        print(path.relative_to(SOURCE))


if __name__ == "__main__":
    main()
