// The client of `archgen lsp`, the live preview beside the editor, and a few verbs as commands. All that is known of the language
// is in the server.

import { ChildProcess, spawn } from "node:child_process";
import * as fs from "node:fs";
import * as path from "node:path";
import * as vscode from "vscode";
import { LanguageClient, LanguageClientOptions, ServerOptions } from "vscode-languageclient/node";

let client: LanguageClient | undefined;
let preview: { panel: vscode.WebviewPanel; server: ChildProcess } | undefined;

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  context.subscriptions.push(
    vscode.commands.registerCommand("archgen.restart", restart),
    vscode.commands.registerCommand("archgen.preview", showPreview),
    vscode.commands.registerCommand("archgen.build", () => runInTerminal("build")),
    vscode.commands.registerCommand("archgen.format", () => runInTerminal("fmt")),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("archgen.path")) void restart();
    }),
    // Without trust no program of the workspace may run.
    vscode.workspace.onDidGrantWorkspaceTrust(() => void restart()),
  );
  await vscode.commands.executeCommand("setContext", "archgen.isActive", true);
  await restart();
}

export async function deactivate(): Promise<void> {
  preview?.server.kill();
  await client?.stop();
}

/** The program: the one of the settings, of the workspace's `.venv`, else of the path. */
export function findProgram(): string {
  const written = vscode.workspace.getConfiguration("archgen").get<string>("path", "").trim();
  if (written) return written;
  const [folder, name] = process.platform === "win32" ? ["Scripts", "archgen.exe"] : ["bin", "archgen"];
  for (const each of vscode.workspace.workspaceFolders ?? []) {
    const program = path.join(each.uri.fsPath, ".venv", folder, name);
    if (fs.existsSync(program)) return program;
  }
  return "archgen";
}

async function restart(): Promise<void> {
  const old = client;
  client = undefined;
  try {
    await old?.stop();
  } catch {
    // It was never up, or is gone.
  }
  if (!vscode.workspace.isTrusted) return;
  const program = findProgram();
  const server: ServerOptions = { command: program, args: ["lsp"] };
  const options: LanguageClientOptions = {
    // What belongs to no project of archgen gets nothing from the server.
    documentSelector: [
      { scheme: "file", language: "yaml" },
      { scheme: "file", language: "markdown" },
      { scheme: "file", pattern: "**/*.{msg,srv,action}" },
    ],
  };
  const next = new LanguageClient("archgen", "archgen", server, options);
  try {
    await next.start();
    client = next;
  } catch (error) {
    await explainFailure(program, error);
  }
}

async function explainFailure(program: string, error: unknown): Promise<void> {
  const reason = error instanceof Error ? error.message : String(error);
  const settings = "Open Settings";
  const answer = await vscode.window.showErrorMessage(
    `archgen's language server does not start: \`${program} lsp\`: ${reason}. It comes with pip install "archgen[lsp]".`,
    settings,
  );
  if (answer === settings) await vscode.commands.executeCommand("workbench.action.openSettings", "archgen.path");
}

/** The folder of the project around the file in the editor, else the first one of the workspace. */
async function findProject(): Promise<string | undefined> {
  const file = vscode.window.activeTextEditor?.document.uri;
  for (let folder = file?.scheme === "file" ? path.dirname(file.fsPath) : ""; folder; ) {
    if (fs.existsSync(path.join(folder, "archgen.yaml"))) return folder;
    const above = path.dirname(folder);
    folder = above === folder ? "" : above;
  }
  const [found] = await vscode.workspace.findFiles("**/archgen.yaml", "**/node_modules/**", 1);
  return found && path.dirname(found.fsPath);
}

async function requireProject(): Promise<string | undefined> {
  if (!vscode.workspace.isTrusted) {
    void vscode.window.showWarningMessage("archgen starts no program until the workspace is trusted.");
    return undefined;
  }
  const project = await findProject();
  if (!project) void vscode.window.showWarningMessage("There is no archgen.yaml here: `archgen init` starts a project.");
  return project;
}

async function runInTerminal(verb: string): Promise<void> {
  const project = await requireProject();
  if (!project) return;
  // As words, never as a line of a shell.
  const terminal = vscode.window.createTerminal({ name: `archgen ${verb}`, cwd: project, shellPath: findProgram(), shellArgs: [verb] });
  terminal.show();
}

async function showPreview(): Promise<void> {
  if (preview) {
    preview.panel.reveal(undefined, true);
    return;
  }
  const project = await requireProject();
  if (!project) return;
  const server = spawn(findProgram(), ["serve", "--port", "0", "--embed"], { cwd: project });
  const panel = vscode.window.createWebviewPanel(
    "archgen.preview",
    "archgen",
    { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true },
    { enableScripts: false, retainContextWhenHidden: true },
  );
  preview = { panel, server };
  const end = (): void => {
    server.kill();
    preview = undefined;
  };
  panel.onDidDispose(end);
  panel.webview.html = writePage("", "Reading the project ...");
  let said = "";
  const listen = (data: Buffer): void => {
    said += data.toString();
    const address = /serving .* at (http:\/\/\S+)\s/.exec(said)?.[1];
    if (!address) return;
    server.stdout.off("data", listen);
    // On another machine the port is passed on.
    void vscode.env.asExternalUri(vscode.Uri.parse(address)).then((uri) => {
      panel.webview.html = writePage(uri.toString(true), "");
    });
  };
  server.stdout.on("data", listen);
  let wrong = "";
  server.stderr.on("data", (data: Buffer) => (wrong = (wrong + data.toString()).slice(-2000)));
  server.on("error", (error) => (panel.webview.html = writePage("", error.message)));
  server.on("exit", (status) => {
    if (preview?.server === server) panel.webview.html = writePage("", `archgen serve ended (${status}). ${wrong}`);
  });
}

/** A page with one frame, and nothing that could run. */
export function writePage(address: string, words: string): string {
  const escape = (text: string): string =>
    text.replace(/[&<>"]/g, (sign) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[sign] ?? sign);
  const origin = address && new URL(address).origin;
  return `<!doctype html>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; frame-src ${escape(origin || "'none'")}">
<style>html, body, iframe { border: 0; margin: 0; padding: 0; width: 100%; height: 100% } p { padding: 1em }</style>
${address ? `<iframe src="${escape(address)}" title="archgen"></iframe>` : `<p>${escape(words)}</p>`}
`;
}
