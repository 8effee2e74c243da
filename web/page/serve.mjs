// node page/serve.mjs [PORT]: serves build/web/page at a local address, which it prints; port 0, the default, takes a free one.
import { createReadStream, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../build/web/page', import.meta.url));
const kinds = { '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.css': 'text/css; charset=utf-8', '.wasm': 'application/wasm' };

// Whether there is such a file; what no file can be called is none.
function isFile(path) {
  try {
    return statSync(path).isFile();
  } catch {
    return false;
  }
}

// The file that an address names; undefined where it is no address.
function fileOf(address) {
  try {
    const path = normalize(decodeURIComponent(new URL(address, 'http://localhost').pathname));
    return path.includes('\0') ? undefined : join(root, path.endsWith('/') ? `${path}index.html` : path);
  } catch {
    return undefined;
  }
}

/** Serves the page to this machine alone; resolves to its address, and what ends it. */
export function serve(port = 0) {
  const server = createServer((request, response) => {
    const file = fileOf(request.url);
    if (!file) return void response.writeHead(400).end();
    if (!file.startsWith(`${root}/`) || !isFile(file)) return void response.writeHead(404).end();
    response.setHeader('Content-Type', kinds[extname(file)] ?? 'application/octet-stream');
    createReadStream(file).pipe(response);
  });
  return new Promise((resolve, reject) => {
    server.on('error', reject);
    server.listen(port, '127.0.0.1', () => resolve({ address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() }));
  });
}

if (import.meta.filename === process.argv[1]) {
  const given = process.argv[2] ?? '0', port = Number(given);
  if (!/^\d+$/.test(given) || port > 65535) {
    console.error(`serve.mjs: no port "${given}", expected a whole number up to 65535`);
    process.exit(2);
  }
  const { address } = await serve(port);
  console.log(`\nThe page: ${address}\nControl-C ends it.`);
}
