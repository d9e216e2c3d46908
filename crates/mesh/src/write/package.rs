//! 3MF: a ZIP archive with a model in XML.

use std::fmt::Write as _;
use std::io::Write as _;

use flate2::write::DeflateEncoder;
use flate2::{Compression, Crc};
use rustc_hash::FxHashMap;
use sdfc_graph::linear_to_srgb8;

use crate::surface::Mesh;

const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;

const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

/// Writes the file; `None` if it is too large for the format.
pub(super) fn three_mf(mesh: &Mesh) -> Option<Vec<u8>> {
    archive(&[
        ("[Content_Types].xml", TYPES.as_bytes()),
        ("_rels/.rels", RELATIONS.as_bytes()),
        ("3D/3dmodel.model", model(mesh).as_bytes()),
    ])
}

/// Writes the model.
fn model(mesh: &Mesh) -> String {
    let mut text = String::from(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">
"#,
    );
    // Writing to a string does not fail.
    let _ = writeln!(text, r#"<metadata name="Application">sdfc</metadata>"#);
    let _ = writeln!(text, r#"<metadata name="Description">{}</metadata>"#, mesh.certificate);
    text += "<resources>\n";
    let (palette, indices) = palette(mesh);
    if !palette.is_empty() {
        text += r#"<m:colorgroup id="2">"#;
        for [r, g, b] in &palette {
            let _ = write!(text, r##"<m:color color="#{r:02X}{g:02X}{b:02X}FF"/>"##);
        }
        text += "</m:colorgroup>\n";
    }
    text += match palette.is_empty() {
        true => r#"<object id="1" type="model"><mesh><vertices>"#,
        false => r#"<object id="1" type="model" pid="2" pindex="0"><mesh><vertices>"#,
    };
    for [x, y, z] in &mesh.vertices {
        let _ = writeln!(text, r#"<vertex x="{x}" y="{y}" z="{z}"/>"#);
    }
    text += "</vertices><triangles>\n";
    for [a, b, c] in &mesh.triangles {
        let _ = write!(text, r#"<triangle v1="{a}" v2="{b}" v3="{c}""#);
        if !palette.is_empty() {
            let [a, b, c] = [a, b, c].map(|id| indices[*id as usize]);
            let _ = write!(text, r#" pid="2" p1="{a}" p2="{b}" p3="{c}""#);
        }
        text += "/>\n";
    }
    text += "</triangles></mesh></object>\n</resources>\n<build><item objectid=\"1\"/></build>\n";
    text += "</model>\n";
    text
}

/// Returns the distinct colours, and for each vertex the index of its colour.
fn palette(mesh: &Mesh) -> (Vec<[u8; 3]>, Vec<usize>) {
    let mut known: FxHashMap<[u8; 3], usize> = FxHashMap::default();
    let mut palette = Vec::new();
    let index = |color: &[f32; 3]| {
        *known.entry(color.map(linear_to_srgb8)).or_insert_with_key(|color| {
            palette.push(*color);
            palette.len() - 1
        })
    };
    let indices = mesh.colors.iter().map(index).collect();
    (palette, indices)
}

/// Packs files into a ZIP archive: <https://pkware.cachefly.net/webdocs/casestudies/APPNOTE.TXT>.
/// `None` if a size needs more than 32 bits.
fn archive(files: &[(&str, &[u8])]) -> Option<Vec<u8>> {
    let mut archive = Vec::new();
    let mut directory = Vec::new();
    for (name, content) in files {
        let mut crc = Crc::new();
        crc.update(content);
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
        // Writing to a vector does not fail.
        let packed = encoder.write_all(content).and_then(|()| encoder.finish()).unwrap_or_default();
        let mut header = Vec::new();
        // Version 2.0, no flags, deflate, 1 January 1980.
        [20u16, 0, 8, 0, 0x21].iter().for_each(|field| header.extend(field.to_le_bytes()));
        let size = |length: usize| u32::try_from(length).ok();
        let sizes = [crc.sum(), size(packed.len())?, size(content.len())?, size(name.len())?];
        sizes.iter().for_each(|field| header.extend(field.to_le_bytes()));
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&header);
        directory.extend([0; 10]);
        directory.extend(size(archive.len())?.to_le_bytes());
        directory.extend(name.as_bytes());
        archive.extend(b"PK\x03\x04");
        archive.extend(&header);
        archive.extend(name.as_bytes());
        archive.extend(packed);
    }
    let count = files.len() as u16;
    let [start, length] = [archive.len(), directory.len()].map(|size| u32::try_from(size).ok());
    archive.extend(&directory);
    archive.extend(b"PK\x05\x06\0\0\0\0");
    [count, count].iter().for_each(|field| archive.extend(field.to_le_bytes()));
    [length?, start?].iter().for_each(|field| archive.extend(field.to_le_bytes()));
    archive.extend([0; 2]);
    Some(archive)
}
