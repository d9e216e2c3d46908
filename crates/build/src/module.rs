//! Generates the module that a program includes.

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;
use sdfc::{Code, ParamRow, ShaderReflection};

/// The reserved words of Rust that are valid names in WGSL.
const RAW: [&str; 2] = ["box", "gen"];

/// Generates the module of a shader.
///
/// # Errors
///
/// The reflection cannot be written as JSON, or its members overlap.
pub(crate) fn text(
    code: &Code,
    reflection: &ShaderReflection,
    bytemuck: bool,
) -> Result<String, String> {
    let described = serde_json::to_string(reflection).map_err(|why| why.to_string())?;
    let shader = match code {
        Code::Text(text) => quote!(pub const SHADER: &str = #text;),
        Code::Words(words) => quote!(pub const SHADER: &[u32] = &[#(#words),*];),
    };
    let lists = reflection.lists.chunks_exact(4).map(|element| quote!([#(#element),*]));
    let params = match &reflection.uniform {
        Some(uniform) => {
            let params = params(&reflection.params, uniform.size, bytemuck)?;
            let (group, binding) = (uniform.group, uniform.binding);
            quote! {
                /// The bind group of the uniform buffer with [`Params`].
                #[allow(dead_code)]
                pub const GROUP: u32 = #group;
                /// The binding of the uniform buffer in its group.
                #[allow(dead_code)]
                pub const BINDING: u32 = #binding;
                #params
            }
        }
        None => TokenStream::new(),
    };
    // Few programs need all items, so each allows dead code.
    let module = quote! {
        /// The shader.
        #[allow(dead_code)]
        #shader
        /// The reflection as JSON: functions, inputs, and the certificate of the field.
        #[allow(dead_code)]
        pub const REFLECTION: &str = #described;
        /// The contents of the storage buffer for long lists; empty without such a buffer.
        #[allow(dead_code)]
        pub const LISTS: &[[f32; 4]] = &[#(#lists),*];
        #params
    };
    Ok(module.to_string())
}

/// A member of the structure of params.
struct Member {
    declared: TokenStream,
    default: TokenStream,
}

/// Generates the structure of params. Its padding is made of members.
fn params(rows: &[ParamRow], size: u32, bytemuck: bool) -> Result<TokenStream, String> {
    let mut members = Vec::new();
    let mut end = 0;
    for row in rows {
        members.extend(padding(end, row.offset)?);
        let (name, doc) = (identifier(&row.name), doc(row));
        let (ty, default) = value(row);
        let declared = quote!(#[doc = #doc] pub #name: #ty);
        members.push(Member { declared, default: quote!(#name: #default) });
        end = row.offset + row.size;
    }
    members.extend(padding(end, size)?);
    let declared = members.iter().map(|member| &member.declared);
    let defaults = members.iter().map(|member| &member.default);
    let derive = bytemuck.then(|| quote!(#[derive(::bytemuck::Pod, ::bytemuck::Zeroable)]));
    let copies = rows.iter().map(copy);
    let bytes = size as usize;
    Ok(quote! {
        /// The values that the shader reads per frame, in the layout of its uniform buffer.
        #[repr(C)]
        #[derive(Clone, Copy, Debug, PartialEq)]
        #derive
        #[allow(dead_code)]
        pub struct Params { #(#declared),* }
        const _: () = assert!(size_of::<Params>() == #bytes);

        impl Default for Params {
            /// Returns the scene's defaults, at time 0.
            fn default() -> Self {
                Self { #(#defaults),* }
            }
        }

        #[allow(dead_code)]
        impl Params {
            /// Returns the bytes of the uniform buffer.
            pub fn to_bytes(&self) -> [u8; #bytes] {
                let mut bytes = [0; #bytes];
                #(#copies)*
                bytes
            }
        }
    })
}

/// Generates the padding between two members, named after its offset.
fn padding(from: u32, to: u32) -> Result<Option<Member>, String> {
    let gap = to.checked_sub(from).ok_or("members of the uniform buffer overlap")?;
    let words = (gap / 4) as usize;
    let name = Ident::new(&format!("_pad{from}"), Span::call_site());
    let (declared, default) = (quote!(pub #name: [u32; #words]), quote!(#name: [0; #words]));
    Ok((words > 0).then_some(Member { declared, default }))
}

/// Generates the copy of a member to its bytes.
fn copy(row: &ParamRow) -> TokenStream {
    let (name, start) = (identifier(&row.name), row.offset as usize);
    let end = start + row.size as usize;
    let value = if row.size == 4 {
        quote!(&self.#name.to_le_bytes())
    } else {
        quote!(self.#name.map(f32::to_le_bytes).as_flattened())
    };
    quote!(bytes[#start..#end].copy_from_slice(#value);)
}

fn identifier(name: &str) -> Ident {
    let new = if RAW.contains(&name) { Ident::new_raw } else { Ident::new };
    new(name, Span::call_site())
}

/// Returns the type and the default of a member.
fn value(row: &ParamRow) -> (TokenStream, TokenStream) {
    if row.kind == "bool" {
        let default = u32::from(row.default.first().is_some_and(|value| *value != 0.0));
        return (quote!(u32), quote!(#default));
    }
    let numbers: Vec<f32> = row.default.iter().map(|&value| value as f32).collect();
    match &numbers[..] {
        [number] => (quote!(f32), quote!(#number)),
        numbers => {
            let count = numbers.len();
            (quote!([f32; #count]), quote!([#(#numbers),*]))
        }
    }
}

fn doc(row: &ParamRow) -> String {
    let range = match (row.min, row.max) {
        (None, None) => String::new(),
        (min, max) => {
            let end = |end: Option<f64>| end.map_or(String::new(), |end| end.to_string());
            format!(", {}..{}", end(min), end(max))
        }
    };
    let of = match row.kind {
        "bool" => "0 or 1".to_owned(),
        "angle" => format!("radians{range}"),
        "color" => "linear red, green, blue, alpha".to_owned(),
        "choice" => format!("index of {}", row.choices.join(", ")),
        kind => format!("{kind}{range}"),
    };
    format!("`{}`: {of}.", row.param)
}
