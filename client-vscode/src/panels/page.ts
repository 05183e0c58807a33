// HTML of a web view: one script, one style sheet, and a policy that allows nothing else.

export interface PageParts {
  readonly title: string;
  /** Addresses of the bundled script and style sheet, as seen by the web view. */
  readonly script: string;
  readonly style: string;
  /** Source of the web view's own files, for the policy. */
  readonly source: string;
  /** An unguessable token; only scripts with it run. */
  readonly nonce: string;
}

/** Return the page as HTML. */
export function page({ title, script, style, source, nonce }: PageParts): string {
  const policy = `default-src 'none'; script-src 'nonce-${nonce}'; style-src ${source}`;
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="UTF-8">
<meta http-equiv="Content-Security-Policy" content="${escaped(policy)}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="stylesheet" href="${escaped(style)}">
<title>${escaped(title)}</title>
</head>
<body><script nonce="${escaped(nonce)}" src="${escaped(script)}"></script></body>
</html>
`;
}

function escaped(text: string): string {
  return text.replaceAll("&", "&amp;").replaceAll('"', "&quot;").replaceAll("<", "&lt;");
}
