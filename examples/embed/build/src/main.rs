//! Shows what the build script made from the scene. The program contains no part of sdfc.

mod bowl {
    include!(concat!(env!("OUT_DIR"), "/bowl.rs"));
}

fn main() {
    let params = bowl::Params { wall: 0.12, ..bowl::Params::default() };
    println!("group {}, binding {}: {:?}", bowl::GROUP, bowl::BINDING, params.to_bytes());
    println!("{} bytes of reflection, {} lists", bowl::REFLECTION.len(), bowl::LISTS.len());
    println!("{}", bowl::SHADER);
}
