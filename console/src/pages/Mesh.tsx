// SPDX-License-Identifier: Apache-2.0
// The first page: a domain, what its mesh must satisfy, and the mesh as it comes.
import { useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import { explain, jobs } from "../client";
import { readFile } from "../domain/domain-file";
import { examples, geoJsonOf, type Example } from "../domain/examples";
import { readGeoJson } from "../domain/geojson";
import { namesOf } from "../domain/names";
import { boxOf, segmentEnds, type PlanarDomain } from "../domain/planar-domain";
import type { GenerateMeshRequest } from "../gen/weft/v1/mesh_service_pb";
import { pythonProgram, shellCommand } from "../jobs/commands";
import { Copy } from "../jobs/copy";
import { DomainPanel } from "../mesh/domain-panel";
import { Keys } from "../mesh/keys";
import { MeshForm } from "../mesh/mesh-form";
import { RunStatus } from "../mesh/run-status";
import { SketchBar } from "../mesh/sketch-bar";
import { emptyForm, fieldOf, isRequest, requestOf, type FormText, type Problems } from "../request/form";
import { navigate } from "../router";
import { boundAt } from "../size/bound-at";
import { heatMapOf } from "../size/heat-map";
import { figure } from "../text";
import { boundsOf } from "../view/bounds";
import { Scale } from "../view/legend";
import { MeshFigures } from "../view/mesh-figures";
import { useMeshRun, useRunState } from "../view/mesh-run";
import { MeshView } from "../view/mesh-view";
import type { Backdrop } from "../view/marks";
import { Sketch } from "../view/sketch";
import "../mesh/mesh.css";

interface Source {
  domain: PlanarDomain;
  text: string | undefined; // of its file, if the page made it
  example: string | undefined;
}

const sourceOf = ({ name, file, text }: Example): Source => ({ domain: readGeoJson(file, text), text, example: name });

// What a domain of one's own begins with, beside a size; what was asked of angles and points stays.
const unbounded: Partial<FormText> = {
  sizeKind: "edge", gradation: "", gradationWithin: false, cellsAcross: "", maxTriangles: "", snap: "",
};

// Where a first drawing goes.
const sheet = { ends: new Float64Array(), box: [0, 0, 10, 7] as [number, number, number, number] };

// Follows the form after a pause, so that typing stays smooth.
function useHeatMap(form: FormText, domain: PlanarDomain | undefined) {
  const [heat, setHeat] = useState<Backdrop & { low: number; high: number }>();
  useEffect(() => {
    const timer = setTimeout(() => {
      const made = domain && heatMapOf(form, domain, boxOf(domain));
      if (!made) return setHeat(undefined);
      const image = document.createElement("canvas");
      image.width = made.pixels.width;
      image.height = made.pixels.height;
      image.getContext("2d")!.putImageData(made.pixels, 0, 0);
      setHeat({ ...made, image, ends: segmentEnds(domain) });
    }, 150);
    return () => clearTimeout(timer);
  }, [form.size, form.sizeKind, domain]);
  return heat;
}

export function MeshPage() {
  const run = useMeshRun();
  const state = useRunState(run);
  const [source, setSource] = useState(() => sourceOf(examples[0]));
  const [form, setForm] = useState<FormText>({ ...emptyForm, ...examples[0].form });
  const [fileProblem, setFileProblem] = useState<string>();
  const [wrong, setWrong] = useState<Problems>({});
  // What the run was asked, and the texts that asked it.
  const [asked, setAsked] = useState<{ request: GenerateMeshRequest; form: FormText; file: string }>();
  const [sketch, setSketch] = useState<Sketch>();
  const [, setCorners] = useState(0);
  const [dropping, setDropping] = useState(false);
  const desk = useRef<HTMLElement>(null);

  const { domain } = source;
  const outline = useMemo(
    () => (sketch ? sheet : { ends: segmentEnds(domain), box: boxOf(domain) }),
    [domain, sketch],
  );
  const heat = useHeatMap(form, sketch ? undefined : domain);
  const bounds = useMemo(() => boundsOf(asked?.request, domain), [asked]);
  const regionNames = useMemo(() => namesOf(asked?.request).regions, [asked]);

  const use = (next: Source, change: Partial<FormText>) => {
    run.close();
    setAsked(undefined);
    setSketch(undefined);
    setFileProblem(undefined);
    setWrong({});
    setSource(next);
    setForm({ ...form, ...change });
  };
  const open = async (file: File) => {
    const answer = await readFile(file);
    if ("problem" in answer) return setFileProblem(answer.problem);
    const box = boxOf(answer.domain);
    // An edge that gives some thousands of triangles, to begin with.
    const edge = box ? Number((Math.hypot(box[2] - box[0], box[3] - box[1]) / 100).toPrecision(1)) : "";
    use({ domain: answer.domain, text: undefined, example: undefined }, {
      ...unbounded, size: String(edge),
    });
  };
  const draw = () => {
    run.close();
    setAsked(undefined);
    setSketch(new Sketch(() => setCorners((n) => n + 1)));
    desk.current!.querySelector<HTMLElement>(".stage canvas")!.focus();
  };
  const finish = () => {
    if (!sketch) return;
    sketch.close();
    if (sketch.rings.length === 0) return;
    const text = geoJsonOf([{ rings: sketch.rings }]);
    desk.current!.querySelector<HTMLElement>("#size")?.focus();
    use({ domain: readGeoJson("drawing.geojson", text), text, example: undefined }, {
      ...unbounded, size: "0.2",
    });
  };

  const made = () => {
    const request = requestOf(form, domain);
    if (isRequest(request)) {
      setWrong({});
      return request;
    }
    setWrong(request);
    document.getElementById(Object.keys(request)[0])?.focus();
    return undefined;
  };
  const start = () => {
    if (sketch) return;
    const request = made();
    if (!request) return;
    setAsked({ request, form, file: domain.name });
    run.start({ kind: "mesh", request });
  };
  const [submitProblem, setSubmitProblem] = useState<string>();
  const submit = async () => {
    const mesh = made();
    if (!mesh) return;
    try {
      const { job } = await jobs.submitJob({ mesh });
      if (job) navigate(`/job/${job.id}`);
    } catch (error) {
      setSubmitProblem(explain(error).sentence);
    }
  };

  // The server's complaint, beside its field as long as that says the same.
  const failure = state.error && explain(state.error);
  const at = failure?.fields.map(fieldOf).find((field) => field !== undefined);
  const told = at !== undefined && asked?.form[at] === form[at];
  const problems = told ? { ...wrong, [at]: failure!.message } : wrong;

  // At once, so that a key just after a button means what the page says then.
  useLayoutEffect(() => {
    const keys = (event: KeyboardEvent) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) start();
      else if (event.key === "Escape" && run.state.phase === "running") run.cancel();
      else return;
      event.preventDefault();
    };
    addEventListener("keydown", keys);
    return () => removeEventListener("keydown", keys);
  });

  return (
    <section
      ref={desk}
      class="mesh-desk"
      aria-label="Mesh"
      data-dropping={dropping || undefined}
      onDragOver={(event) => {
        event.preventDefault();
        setDropping(true);
      }}
      onDragLeave={(event) => {
        if (!event.currentTarget.contains(event.relatedTarget as Node | null)) setDropping(false);
      }}
      onDrop={(event) => {
        event.preventDefault();
        setDropping(false);
        const file = event.dataTransfer?.files[0];
        if (file) void open(file);
      }}
    >
      <form
        class="desk-side"
        noValidate
        onSubmit={(event) => {
          event.preventDefault();
          start();
        }}
      >
        <div class="desk-scroll">
          <DomainPanel
            {...source}
            problem={fileProblem}
            drawing={sketch !== undefined}
            onExample={(example) => use(sourceOf(example), { ...emptyForm, ...example.form })}
            onFile={(file) => void open(file)}
            onDraw={draw}
          />
          <MeshForm form={form} problems={problems} onChange={(change) => setForm({ ...form, ...change })} />
        </div>
        <div class="desk-foot">
          <button class="primary" type="submit" disabled={sketch !== undefined} title="Ctrl+Enter">
            Mesh
          </button>
          <button type="button" disabled={sketch !== undefined} title="The server keeps the mesh of a job" onClick={() => void submit()}>
            As a job
          </button>
          {submitProblem && (
            <p class="problem" role="alert">
              {submitProblem}
            </p>
          )}
        </div>
      </form>
      <MeshView run={run} regionNames={regionNames} outline={outline} bounds={bounds} sketch={sketch} backdrop={heat}>
        {heat && state.chunks === 0 && (
          <Scale
            title={form.sizeKind === "edge" ? "Length of edges, as asked for" : "Area, as asked for"}
            by="area"
            ends={[heat.low, Math.sqrt(heat.low * heat.high), heat.high].map(figure)}
          />
        )}
        {sketch && <SketchBar sketch={sketch} onDone={finish} onCancel={() => setSketch(undefined)} />}
        {dropping && <p class="drop-here">Drop a .poly, GeoJSON or WKT file</p>}
      </MeshView>
      <aside class="desk-side" aria-label="Result">
        <div class="desk-scroll">
          {state.phase === "idle" && <Keys drawing={sketch !== undefined} />}
          <RunStatus run={run} told={told} />
          <MeshFigures
            run={run}
            regionNames={regionNames}
            boundAt={asked && ((centroid, region) => boundAt(asked.form, domain, centroid, region))}
          />
          {asked && state.phase === "done" && (
            <div class="row copies" role="group" aria-label="Copy the request">
              <span class="faint">Copy as</span>
              <Copy label="weft mesh" text={shellCommand(asked.request, asked.file)} />
              <Copy label="Python" text={pythonProgram(asked.request, asked.file)} />
            </div>
          )}
        </div>
      </aside>
    </section>
  );
}
