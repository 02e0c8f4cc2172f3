// The data are there as they are, or compressed. Where they are unpacked, the page begins later.
const plain = document.getElementById("data");
const unpacked = async () => {
  const packed = JSON.parse(document.getElementById("packed-data").textContent);
  const bytes = Uint8Array.from(atob(packed), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return JSON.parse(await new Response(stream).text());
};
const complain = error => { document.getElementById("text").textContent = "This browser cannot unpack the page: " + error.message; };
if (plain) start(JSON.parse(plain.textContent)); else unpacked().then(start).catch(complain);
