# SPDX-License-Identifier: Apache-2.0
"""The Helm chart, rendered by helm_render.go, fits the schemas of Kubernetes and of the operators, and makes
of its values what they say."""
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
SECURE = {"tls": {"secret": "weft-tls", "clients": True}, "tokens": {"secret": "weft-tokens", "key": "callers"}}


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
    """By kind."""
    return {each["kind"]: each for each in yaml.safe_load_all(text) if each}


def test_one_server_has_a_volume_to_itself(renderer):
    made = objects(rendered(renderer))
    assert not {"ScaledObject", "ServiceMonitor"} & set(made)
    assert (made["Deployment"]["spec"]["replicas"], made["Deployment"]["spec"]["strategy"]) == \
        (1, {"type": "Recreate"})
    data, = made["Deployment"]["spec"]["template"]["spec"]["volumes"]
    assert data["persistentVolumeClaim"] == {"claimName": made["PersistentVolumeClaim"]["metadata"]["name"]}
    assert made["NetworkPolicy"]["spec"]["egress"] == []


def test_several_servers_share_a_store_and_leave_their_number_to_keda(renderer):
    made = objects(rendered(renderer, STORE))
    assert "PersistentVolumeClaim" not in made and "replicas" not in made["Deployment"]["spec"]
    container, = made["Deployment"]["spec"]["template"]["spec"]["containers"]
    assert {"name": "WEFT_DATA", "value": ""} in container["env"]
    assert {"name": "WEFT_STORE", "valueFrom": {"secretKeyRef": {"name": "weft-store", "key": "uri"}}} in \
        container["env"]
    ports = {port["port"] for rule in made["NetworkPolicy"]["spec"]["egress"] for port in rule["ports"]}
    assert ports == {53, 5432}


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


def test_certificates_and_tokens_are_mounted_and_the_probes_go_round_them(renderer):
    made = objects(rendered(renderer, SECURE))
    pod = made["Deployment"]["spec"]["template"]["spec"]
    container, = pod["containers"]
    folders = {mount["name"]: mount["mountPath"] for mount in container["volumeMounts"]}
    secrets = {volume["name"]: volume["secret"] for volume in pod["volumes"] if "secret" in volume}
    assert {name: secret["secretName"] for name, secret in secrets.items()} == \
        {"tls": "weft-tls", "tokens": "weft-tokens"}
    assert all(secret["defaultMode"] == 0o440 for secret in secrets.values())  # for the group of fsGroup alone
    variables = {variable["name"]: variable.get("value") for variable in container["env"]}
    assert variables["WEFT_TLS_CERT"] == folders["tls"] + "/tls.crt"
    assert variables["WEFT_TLS_KEY"] == folders["tls"] + "/tls.key"
    assert variables["WEFT_TLS_CLIENT_CA"] == folders["tls"] + "/ca.crt"
    assert variables["WEFT_TOKENS"] == folders["tokens"] + "/callers"
    for probe in ("startupProbe", "livenessProbe", "readinessProbe"):
        assert container[probe]["httpGet"] == {"port": "metrics", "path": "/healthz"}
    assert made["Service"]["spec"]["ports"][0]["appProtocol"] == "https"


def test_callbacks_have_their_secrets_and_a_way_out(renderer):
    made = objects(rendered(renderer, {"callbacks": {"secret": "weft-callbacks"}}))
    pod = made["Deployment"]["spec"]["template"]["spec"]
    container, = pod["containers"]
    assert {"name": "WEFT_NOTIFY_SECRETS", "value": "/etc/weft/callbacks/secrets"} in container["env"]
    folders = {mount["name"]: mount["mountPath"] for mount in container["volumeMounts"]}
    assert folders["callbacks"] == "/etc/weft/callbacks"
    names = {volume["name"]: volume["secret"]["secretName"] for volume in pod["volumes"] if "secret" in volume}
    assert names == {"callbacks": "weft-callbacks"}
    ports = {port["port"] for rule in made["NetworkPolicy"]["spec"]["egress"] for port in rule["ports"]}
    assert ports == {53, 80, 443}


def test_tokens_alone_leave_the_probes_of_grpc(renderer):
    made = objects(rendered(renderer, {"tokens": {"secret": "weft-tokens"}}))
    container, = made["Deployment"]["spec"]["template"]["spec"]["containers"]
    assert {"name": "WEFT_TOKENS", "value": "/etc/weft/tokens/tokens"} in container["env"]
    assert "grpc" in container["livenessProbe"]


def test_the_variables_of_the_chart_are_those_of_the_server(renderer):
    container, = objects(rendered(renderer, SECURE))["Deployment"]["spec"]["template"]["spec"]["containers"]
    flags = (ROOT / "docs/flags.md").read_text()
    for variable in container["env"]:
        assert f"(Env:{variable['name']})" in flags, variable["name"]


def test_the_chart_has_the_version_of_the_programs():
    version, = re.findall(r"^project\(weft VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)
    chart = yaml.safe_load((CHART / "Chart.yaml").read_text())
    assert (chart["version"], chart["appVersion"]) == (version, version)


def test_all_that_is_rendered_fits_the_schemas(renderer):
    if not (ROOT / "deploy/node_modules").is_dir():
        pytest.skip("deploy/node_modules is not installed; tests/run.sh does that")
    judge = ["node", ROOT / "deploy/check-kubernetes.mjs"]
    text = rendered(renderer, STORE) + rendered(renderer) + rendered(renderer, SECURE)
    done = subprocess.run(judge, input=text, capture_output=True, text=True)
    assert (done.returncode, done.stderr, done.stdout) == (0, "", "16 objects\n")
    wrong = text.replace("clusterIP: None", "clusterIP: [none]")
    assert subprocess.run(judge, input=wrong, capture_output=True, text=True).returncode == 1
