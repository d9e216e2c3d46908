// A job type of Flamenco: draws the frames of a scene, several per task, and each of them in bands
// of rows if that is asked for. Put this file into the folder `scripts` beside Flamenco Manager.
//
// Workers need the command sdfc, or a variable {sdfc} of the manager that names it.

const JOB_TYPE = {
    label: "sdfc frames",
    description: "Draw the frames of a scene of sdfc",
    settings: [
        { key: "sdfc", type: "string", default: "sdfc",
            description: "The command sdfc, its path on the workers, or {sdfc}" },
        { key: "scene", type: "string", subtype: "file_path", required: true,
            description: "The scene. Files that it imports must be in its folder" },
        { key: "output", type: "string", subtype: "file_path", required: true,
            description: "A name such as /shared/frame.png. Frame 7 becomes frame.0007.png" },
        { key: "frames", type: "string", required: true, default: "0-23",
            description: "Frames, such as 0-23 or 3, 5-10" },
        { key: "chunk_size", type: "int32", default: 4, description: "Frames per task" },
        { key: "bands", type: "int32", default: 1,
            description: "Bands of rows per frame, each in a task of its own" },
        { key: "fps", type: "float", default: 30, description: "Frames per second" },
        { key: "size", type: "string", default: "1920x1080",
            description: "Width and height in pixels" },
        { key: "device", type: "string", choices: ["auto", "gpu", "cpu"], default: "auto",
            description: "What draws" },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    for (const chunk of frameChunker(settings.frames, settings.chunk_size)) {
        const tasks = [];
        for (let band = 1; band <= settings.bands; band++) {
            tasks.push(drawingTask(settings, chunk, band));
        }
        tasks.forEach((task) => job.addTask(task));
        if (settings.bands > 1) {
            const join = joiningTask(settings, chunk);
            tasks.forEach((task) => join.addDependency(task));
            job.addTask(join);
        }
    }
}

// A task that runs again skips finished frames.
function drawingTask(settings, chunk, band) {
    const part = settings.bands > 1 ? `, band ${band} of ${settings.bands}` : "";
    const task = author.Task(`draw ${chunk}${part}`, "misc");
    for (const range of rangesOf(chunk)) {
        const args = [
            "render", settings.scene,
            "--output", settings.output,
            "--frames", range,
            "--fps", String(settings.fps),
            "--size", settings.size,
            "--backend", settings.device,
            "--resume",
            "--progress", "json",
        ];
        if (settings.bands > 1) {
            args.push("--region", `${band}/${settings.bands}`);
        }
        task.addCommand(author.Command("exec", { exe: settings.sdfc, args }));
    }
    return task;
}

function joiningTask(settings, chunk) {
    const task = author.Task(`join ${chunk}`, "misc");
    for (const range of rangesOf(chunk)) {
        const [first, last = first] = range.split("-").map(Number);
        for (let frame = first; frame <= last; frame++) {
            const args = ["join", "--output", numbered(settings.output, frame)];
            task.addCommand(author.Command("exec", { exe: settings.sdfc, args }));
        }
    }
    return task;
}

// A chunk is a list of frames and ranges, such as 3,5-7.
function rangesOf(chunk) {
    return String(chunk).split(",").map((range) => range.trim());
}

// The name that sdfc gives to a frame: frame.0007.png for frame.png.
function numbered(output, frame) {
    const number = String(frame).padStart(4, "0");
    const extension = /\.[^./\\]+$/;
    return extension.test(output)
        ? output.replace(extension, (end) => `.${number}${end}`)
        : `${output}.${number}`;
}
