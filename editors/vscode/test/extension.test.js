// The bundled extension against a stand-in of the editor: what it starts, and what it says where that fails.
"use strict";
const assert = require("node:assert");
const { EventEmitter } = require("node:events");
const fs = require("node:fs");
const Module = require("node:module");
const os = require("node:os");
const path = require("node:path");
const { test } = require("node:test");

const BUNDLE = path.join(__dirname, "..", "dist", "extension.js");

function makeEditor({ trusted = true, setting = "", folder = "" } = {}) {
  const said = [];
  const commands = new Map();
  const terminals = [];
  const panels = [];
  const vscode = {
    ViewColumn: { Beside: 2 },
    Uri: { parse: (text) => ({ toString: () => text }) },
    env: { asExternalUri: async (uri) => uri },
    commands: {
      registerCommand: (name, run) => (commands.set(name, run), { dispose() {} }),
      executeCommand: async () => undefined,
    },
    workspace: {
      isTrusted: trusted,
      workspaceFolders: folder ? [{ uri: { fsPath: folder } }] : [],
      getConfiguration: () => ({ get: (_, other) => setting || other }),
      onDidChangeConfiguration: () => ({ dispose() {} }),
      onDidGrantWorkspaceTrust: () => ({ dispose() {} }),
      findFiles: async () => (folder ? [{ fsPath: path.join(folder, "archgen.yaml") }] : []),
    },
    window: {
      activeTextEditor: undefined,
      showErrorMessage: async (text) => void said.push(text),
      showWarningMessage: async (text) => void said.push(text),
      createTerminal: (options) => (terminals.push(options), { show() {} }),
      createWebviewPanel: (...words) => {
        const panel = { words, webview: { html: "" }, reveal() {}, onDidDispose() {} };
        panels.push(panel);
        return panel;
      },
    },
  };
  return { vscode, said, commands, terminals, panels };
}

/** Load the bundle anew with stand-ins for what it asks the editor and the system for. */
function load(editor, spawned = []) {
  const original = Module._load;
  delete require.cache[BUNDLE];
  Module._load = function (request, ...others) {
    if (request === "vscode") return new Proxy(editor.vscode, { get: (all, name) => all[name] ?? class {} });
    if (request === "node:child_process" || request === "child_process") {
      return { ...original.call(this, request, ...others), spawn: (...words) => start(spawned, words) };
    }
    return original.call(this, request, ...others);
  };
  try {
    return require(BUNDLE);
  } finally {
    Module._load = original;
  }
}

function start(spawned, words) {
  const child = Object.assign(new EventEmitter(), { stdout: new EventEmitter(), stderr: new EventEmitter(), kill() {} });
  spawned.push({ words, child });
  return child;
}

test("nothing is started before the workspace is trusted", async () => {
  const editor = makeEditor({ trusted: false });
  const spawned = [];
  const extension = load(editor, spawned);
  await extension.activate({ subscriptions: [] });
  await editor.commands.get("archgen.preview")();
  assert.deepStrictEqual(spawned, []);
  assert.match(editor.said[0], /trusted/);
});

test("the program is that of the settings, of .venv, of the path", () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "archgen-"));
  const program = path.join(folder, ".venv", "bin", "archgen");
  assert.strictEqual(load(makeEditor({ folder })).findProgram(), "archgen");
  fs.mkdirSync(path.dirname(program), { recursive: true });
  fs.writeFileSync(program, "");
  assert.strictEqual(load(makeEditor({ folder })).findProgram(), program);
  assert.strictEqual(load(makeEditor({ folder, setting: "/opt/archgen" })).findProgram(), "/opt/archgen");
  fs.rmSync(folder, { recursive: true });
});

test("commands run the program with words, in the project's folder", async () => {
  const editor = makeEditor({ folder: "/robot" });
  load(editor);
  const extension = load(editor);
  editor.vscode.workspace.isTrusted = false;
  await extension.activate({ subscriptions: [] });
  editor.vscode.workspace.isTrusted = true;
  await editor.commands.get("archgen.format")();
  assert.deepStrictEqual(editor.terminals, [{ name: "archgen fmt", cwd: "/robot", shellPath: "archgen", shellArgs: ["fmt"] }]);
});

test("the preview frames what the server says, and nothing else", async () => {
  const editor = makeEditor({ folder: "/robot" });
  const spawned = [];
  const extension = load(editor, spawned);
  editor.vscode.workspace.isTrusted = false;
  await extension.activate({ subscriptions: [] });
  editor.vscode.workspace.isTrusted = true;
  await editor.commands.get("archgen.preview")();
  const [{ words, child }] = spawned;
  assert.deepStrictEqual([words[0], words[1], words[2].cwd], ["archgen", ["serve", "--port", "0", "--embed"], "/robot"]);
  child.stdout.emit("data", Buffer.from("serving Robot at http://127.0.0.1:8471/"));
  child.stdout.emit("data", Buffer.from("abc/  (Ctrl-C ends it)\n"));
  await new Promise((resolve) => setImmediate(resolve));
  assert.match(editor.panels[0].webview.html, /frame-src http:\/\/127\.0\.0\.1:8471"/);
  assert.match(editor.panels[0].webview.html, /<iframe src="http:\/\/127\.0\.0\.1:8471\/abc\/"/);
  child.emit("exit", 1);
  assert.match(editor.panels[0].webview.html, /ended \(1\)/);
});

test("words of the server are text in the page", () => {
  const page = load(makeEditor()).writePage("", '<script>"&');
  assert.match(page, /&lt;script&gt;&quot;&amp;/);
  assert.match(page, /frame-src 'none'/);
});
