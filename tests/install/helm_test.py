# SPDX-License-Identifier: Apache-2.0
"""The Helm chart, rendered by helm_render.go: it makes what deploy/kubernetes makes, as kubectl says it,
and fits the schemas of Kubernetes and of the operators."""
import json
import os
import pathlib
import re
import subprocess

import pytest
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
CHART = ROOT / "deploy/helm/weft"
STORE = {"store": {"secret": "weft-store"}}


@pytest.fixture(scope="module")
def renderer(tmp_path_factory):
    program = tmp_path_factory.mktemp("helm") / "helm_render"
    environment = {**os.environ, "GO111MODULE": "off", "GOFLAGS": "", "GOCACHE": str(program.parent / "cache")}
    subprocess.run(["go", "build", "-o", program, ROOT / "tests/install/helm_render.go"], check=True,
                   env=environment)
    return program


def merged(values, changes):
    return {key: merged(values[key], changes[key]) if isinstance(values.get(key), dict) and key in changes
            else changes.get(key, values.get(key)) for key in {**values, **changes}}


def rendered(renderer, changes=(), release="weft"):
    """The text that `helm template RELEASE` would print with these values."""
    chart = yaml.safe_load((CHART / "Chart.yaml").read_text())
    values = merged(yaml.safe_load((CHART / "values.yaml").read_text()), dict(changes))
    given = {"context": {"Values": values, "Release": {"Name": release},
                         "Chart": {name[0].upper() + name[1:]: value for name, value in chart.items()}},
             "templates": {path.name: path.read_text() for path in (CHART / "templates").iterdir()}}
    return subprocess.run([renderer], input=json.dumps(given), check=True, capture_output=True,
                          text=True).stdout


def objects(text):
    """By kind; an order that Kubernetes does not heed is that of names."""
    found = {each["kind"]: each for each in yaml.safe_load_all(text) if each}
    for container in found["Deployment"]["spec"]["template"]["spec"]["containers"]:
        container["env"].sort(key=lambda variable: variable["name"])
    return found


@pytest.mark.parametrize("overlay, values", [("single", {}), ("cluster", STORE)])
def test_the_chart_makes_what_kustomize_makes(renderer, overlay, values):
    made = subprocess.run(["kubectl", "kustomize", ROOT / "deploy/kubernetes/overlays" / overlay],
                          capture_output=True, text=True)
    if made.returncode:
        pytest.skip("no kubectl with kustomize 4 or later")
    assert objects(rendered(renderer, values)) == objects(made.stdout)


def test_every_object_has_the_name_of_the_release(renderer):
    made = objects(rendered(renderer, STORE, "coast"))
    assert {each["metadata"]["name"] for each in made.values()} == {"coast"}
    assert made["Service"]["spec"]["selector"] == {"app.kubernetes.io/name": "coast"}
    query = made["ScaledObject"]["spec"]["triggers"][0]["metadata"]["query"]
    assert query == 'max(weft_queue_length{job="coast", queue="jobs"})'


def test_values_are_taken(renderer):
    made = objects(rendered(renderer, {
        "image": {"repository": "registry.test/mesher", "tag": "7"}, "volume": {"size": "1Ti"},
        "environment": {"WEFT_JOBS": 2}, "resources": {"cpu": "16", "memory": "32Gi"}}))
    container, = made["Deployment"]["spec"]["template"]["spec"]["containers"]
    assert container["image"] == "registry.test/mesher:7"
    assert {"name": "WEFT_JOBS", "value": "2"} in container["env"]
    assert container["resources"]["limits"] == {"cpu": "16", "memory": "32Gi"}
    assert made["PersistentVolumeClaim"]["spec"]["resources"]["requests"]["storage"] == "1Ti"


def test_the_chart_has_the_version_of_the_programs():
    version, = re.findall(r"^project\(weft VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)
    chart = yaml.safe_load((CHART / "Chart.yaml").read_text())
    assert (chart["version"], chart["appVersion"]) == (version, version)


def test_all_that_is_rendered_fits_the_schemas(renderer):
    if not (ROOT / "deploy/node_modules").is_dir():
        pytest.skip("deploy/node_modules is not installed; tests/run.sh does that")
    judge = ["node", ROOT / "deploy/check-kubernetes.mjs"]
    text = rendered(renderer, STORE) + rendered(renderer)
    done = subprocess.run(judge, input=text, capture_output=True, text=True)
    assert (done.returncode, done.stderr, done.stdout) == (0, "", "11 objects\n")
    wrong = text.replace("clusterIP: None", "clusterIP: [none]")
    assert subprocess.run(judge, input=wrong, capture_output=True, text=True).returncode == 1
