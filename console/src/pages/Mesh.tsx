// SPDX-License-Identifier: Apache-2.0
// The first page: a domain, what its mesh must satisfy, and the mesh as it comes.
import { useCallback, useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import { explain, jobs, meshes } from "../client";
import { readFile, type Finding } from "../domain/domain-file";
import { domainOf, examples, geoJsonOf, type Example, type Polygon } from "../domain/examples";
import { regionNamesOf } from "../domain/names";
import { boxOf, segmentEnds } from "../domain/outline";
import { Downloads } from "../download/downloads";
import { Measure, type Domain, type GenerateMeshRequest } from "../gen/weft/v1/mesh_service_pb";
import { pythonProgram, shellCommand } from "../jobs/commands";
import { Copy } from "../jobs/copy";
import { DomainPanel } from "../mesh/domain-panel";
import { Keys } from "../mesh/keys";
import { MeshForm } from "../mesh/mesh-form";
import { RunStatus } from "../mesh/run-status";
import { SketchBar } from "../mesh/sketch-bar";
import { emptyForm, fieldOf, isRequest, requestOf, type FormText, type Problems } from "../request/form";
import { navigate } from "../router";
import { count, figure } from "../text";
import { Scale } from "../view/legend";
import { MeshFigures } from "../view/mesh-figures";
import { useMeshRun, useRunState } from "../view/mesh-run";
import { MeshView } from "../view/mesh-view";
import type { Backdrop } from "../view/marks";
import { gridOver, heatMapOf, middlesOf, sampleSize } from "../view/sampled-size";
import { Sketch } from "../view/sketch";
import "../mesh/mesh.css";

interface Source {
  name: string; // of the file that it is, or could be, in
  domain: Domain;
  text: string | undefined; // of its file, if the page made it
  example: string | undefined;
  inMetres: boolean; // projected from longitude and latitude
  findings: Finding[];
  faults: number;
  project: (() => void) | undefined;
}

const own = (name: string, polygons: Polygon[], example?: string): Source => ({
  name, domain: domainOf(polygons), text: geoJsonOf(polygons), example, inMetres: false, findings: [], faults: 0, project: undefined,
});
const sourceOf = ({ name, file, polygons }: Example): Source => own(file, polygons, name);

// What a domain of one's own begins with, beside a size; what was asked of angles and points stays.
const unbounded: Partial<FormText> = {
  sizeKind: "edge", gradation: "", gradationWithin: false, cellsAcross: "", maxTriangles: "", snap: "",
};

// Where a first drawing goes.
const sheet = { ends: new Float64Array(), box: [0, 0, 10, 7] as [number, number, number, number] };

// To two digits.
const rounded = (n: number) => Number(n.toPrecision(2));

// Of a domain with more, the server is not asked while a form is filled in.
const mostFollowed = 100_000; // points

interface Preview {
  triangles: number; // that the mesh will have, about
  heat: (Backdrop & { low: number; high: number }) | undefined; // if the size varies
}

// What the form asks for, after a pause, so that typing stays smooth.
function usePreview(form: FormText, domain: Domain | undefined, ends: Float64Array): Preview | undefined {
  const [preview, setPreview] = useState<Preview>();
  useEffect(() => {
    const stop = new AbortController();
    const ask = async () => {
      const box = domain && boxOf(domain);
      const request = domain && requestOf(form, domain);
      setPreview(undefined);
      if (!box || !request || !isRequest(request) || domain.points.length > 2 * mostFollowed) return;
      const grid = gridOver(box);
      // What is wrong with the request is told when it is sent.
      const told = await sampleSize(meshes, request, middlesOf(grid), { signal: stop.signal }).catch(() => undefined);
      if (!told || stop.signal.aborted) return;
      const made = heatMapOf(grid, told.bounds, request.size?.measure ?? Measure.AREA);
      if (!made) return setPreview({ triangles: told.triangles, heat: undefined });
      const image = document.createElement("canvas");
      image.width = made.pixels.width;
      image.height = made.pixels.height;
      image.getContext("2d")!.putImageData(made.pixels, 0, 0);
      setPreview({ triangles: told.triangles, heat: { ...made, image, ends } });
    };
    const timer = setTimeout(() => void ask(), 250);
    return () => {
      clearTimeout(timer);
      stop.abort();
    };
  }, [form, domain]);
  return preview;
}

export function MeshPage() {
  const run = useMeshRun();
  const state = useRunState(run);
  const [source, setSource] = useState(() => sourceOf(examples[0]));
  const [form, setForm] = useState<FormText>({ ...emptyForm, ...examples[0].form });
  const [fileProblem, setFileProblem] = useState<string>();
  const [wrong, setWrong] = useState<Problems>({});
  // What the run was asked, and the texts that asked it.
  const [asked, setAsked] = useState<{ request: GenerateMeshRequest; form: FormText; source: Source }>();
  const [reading, setReading] = useState<string>();
  const stopReading = useRef(new AbortController());
  const [sketch, setSketch] = useState<Sketch>();
  const [, setCorners] = useState(0);
  const [dropping, setDropping] = useState(false);
  const desk = useRef<HTMLElement>(null);

  const { domain } = source;
  const ends = useMemo(() => segmentEnds(domain), [domain]);
  const outline = useMemo(() => (sketch ? sheet : { ends, box: boxOf(domain) }), [domain, sketch]);
  const preview = usePreview(form, sketch ? undefined : domain, ends);
  const heat = preview?.heat;
  const boundAt = useCallback(
    async (centroid: [number, number]) => {
      const told = asked && (await sampleSize(meshes, asked.request, centroid, {}).catch(() => undefined));
      return told && told.bounds[0] < Infinity ? told.bounds[0] : undefined;
    },
    [asked],
  );
  const regionNames = useMemo(() => regionNamesOf(asked?.request), [asked]);

  const use = (next: Source, change: Partial<FormText>) => {
    stopReading.current.abort();
    setReading(undefined);
    run.close();
    setAsked(undefined);
    setSketch(undefined);
    setFileProblem(undefined);
    setWrong({});
    setSource(next);
    setForm((before) => ({ ...before, ...change }));
  };
  // The last file that was given counts.
  const open = async (file: File, inMetres = false) => {
    stopReading.current.abort();
    const { signal } = (stopReading.current = new AbortController());
    setReading(file.name);
    try {
      const read = await readFile(file, inMetres, signal);
      const box = boxOf(read.domain);
      // An edge that gives some thousands of triangles, to begin with.
      const edge = box ? Number((Math.hypot(box[2] - box[0], box[3] - box[1]) / 100).toPrecision(1)) : "";
      const ofCoordinates = read.findings.some(({ warning }) => warning === "coordinates");
      const project = !inMetres && ofCoordinates ? () => void open(file, true) : undefined;
      use({ ...read, name: file.name, text: undefined, example: undefined, inMetres, project }, { ...unbounded, size: String(edge) });
    } catch (error) {
      if (signal.aborted) return;
      setReading(undefined);
      setFileProblem(explain(error).sentence);
    }
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
    desk.current!.querySelector<HTMLElement>("#size")?.focus();
    use(own("drawing.geojson", [{ rings: sketch.rings }]), { ...unbounded, size: "0.2" });
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
    setAsked({ request, form, source });
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
            reading={reading}
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
          {/* It has its place before it is known, so that no button moves under the mouse. */}
          <span class="faint">{preview?.triangles ? `about ${count(rounded(preview.triangles))} triangles` : "\u00a0"}</span>
          {submitProblem && (
            <p class="problem" role="alert">
              {submitProblem}
            </p>
          )}
        </div>
      </form>
      <MeshView run={run} regionNames={regionNames} outline={outline} isAsked={asked !== undefined} sketch={sketch} backdrop={heat}>
        {heat && state.chunks === 0 && (
          <Scale
            title={form.sizeKind === "edge" ? "Length of edges, as asked for" : "Area, as asked for"}
            by="area"
            ends={[heat.low, Math.sqrt(heat.low * heat.high), heat.high].map(figure)}
          />
        )}
        {sketch && <SketchBar sketch={sketch} onDone={finish} onCancel={() => setSketch(undefined)} />}
        {dropping && <p class="drop-here">Drop the file of a domain</p>}
      </MeshView>
      <aside class="desk-side" aria-label="Result">
        <div class="desk-scroll">
          {state.phase === "idle" && <Keys drawing={sketch !== undefined} />}
          <RunStatus run={run} told={told} />
          <MeshFigures
            run={run}
            regionNames={regionNames}
            boundAt={asked && boundAt}
          />
          {asked && state.phase === "done" && (
            <>
              <Downloads of={asked.request} stem={asked.source.name.replace(/\.\w+$/, "")} />
              <div class="row copies" role="group" aria-label="Copy the request">
                <span class="faint">Copy as</span>
                <Copy label="weft mesh" text={shellCommand(asked.request, asked.source)} />
                <Copy label="Python" text={pythonProgram(asked.request, asked.source)} />
              </div>
            </>
          )}
        </div>
      </aside>
    </section>
  );
}
